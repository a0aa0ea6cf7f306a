#include "montelux/transport/light_end.h"

#include "montelux/scene/light/light.h"
#include "montelux/scene/light/light_sampling.h"

namespace montelux {

float next_event_density(const SceneView& scene, float time, LightEnd& end, const ReferencePoint& from,
                         Vec3f w, float distance2) {
    const float choice = scene.light_sampler->probability(from, end.light, end.hit.part);
    if (end.is_delta()) return choice;
    end.hit.wi = -w;
    return end.of_light(choice * pdf_li({scene, end.light, time}, from, end.hit), w, distance2);
}

LightEnd end_at(const SceneView& scene, float time, Index light, const LightHit& hit, Vec3f w) {
    LightEnd end{.light = light, .kind = kind_of(scene.lights[light]), .hit = hit};
    const float choice = scene.emitting_lights->probability({}, light, hit.part);
    const EmissionPdf pdf = pdf_le({scene, light, time}, hit, w);
    end.emission = choice * (end.is_delta() ? 1 : end.at_infinity() ? pdf.direction : pdf.position);
    end.edge = end.at_infinity() ? pdf.position : pdf.direction;
    return end;
}

} // namespace montelux
