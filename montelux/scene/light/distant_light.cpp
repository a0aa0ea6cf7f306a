#include "montelux/scene/light/distant_light.h"

#include "montelux/scene/light/light_context.h"
#include "montelux/scene/light/scene_disk.h"
#include "montelux/scene/light/shadow_ray.h"
#include "montelux/scene/light/visible_mean.h"

namespace montelux {

DistantLight DistantLight::moved(const Transform& world_from_own) const {
    return {spectrum, scale, normalize(world_from_own.vector(to_light))};
}

Index DistantLight::part_count(const LightContext&) const { return 1; }

std::optional<LightSample> DistantLight::sample_li(const LightContext& context, Index,
                                                   const ReferencePoint& from, Vec2f,
                                                   const SampledWavelengths& lambda) const {
    return LightSample{.radiance = context.scene.sample(spectrum, lambda) * scale,
                       .wi = to_light,
                       .pdf = 1,
                       .delta = true,
                       .invisible = true,
                       .shadow = shadow_ray_to_infinity(from, to_light)};
}

float DistantLight::pdf_li(const LightContext&, const ReferencePoint&, const LightHit&) const { return 0; }

SampledSpectrum DistantLight::radiance(const LightContext&, const ReferencePoint&, const LightHit&,
                                       const SampledWavelengths&) const {
    return {};
}

std::optional<EmissionSample> DistantLight::sample_le(const LightContext& context, Index, Vec2f u, Vec2f,
                                                      const SampledWavelengths& lambda) const {
    const SceneDisk disk(context.tables().scene_bounds);
    EmissionSample s;
    s.radiance = context.scene.sample(spectrum, lambda) * scale;
    s.ray = disk.sample(-to_light, u);
    s.pdf_position = disk.pdf();
    s.pdf_direction = 1;
    return s;
}

EmissionPdf DistantLight::pdf_le(const LightContext& context, const LightHit&, Vec3f) const {
    return {SceneDisk(context.tables().scene_bounds).pdf(), 0};
}

void DistantLight::powers(const LightContext& context, std::span<double> parts) const {
    parts[0] = SceneDisk(context.tables().scene_bounds).area() *
               (double(scale) * visible_mean(context.scene.spectrum(spectrum)));
}

std::optional<LightBounds> DistantLight::bounds(const LightContext&, Index) const { return std::nullopt; }

} // namespace montelux
