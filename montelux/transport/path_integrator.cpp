#include "montelux/transport/path_integrator.h"

#include <cmath>

#include "montelux/mc/random/sample_stream.h"
#include "montelux/transport/one_copy.h"
#include "montelux/transport/path_shading.h"

namespace montelux {

namespace {

// (x, y) such that a = x dpdu + y dpdv in the least-squares sense.
Vec2f in_tangents(Vec3f a, Vec3f dpdu, Vec3f dpdv) {
    float uu = dot(dpdu, dpdu), uv = dot(dpdu, dpdv), vv = dot(dpdv, dpdv);
    float determinant = uu * vv - uv * uv;
    if (!(std::abs(determinant) > 0)) return {0, 0};
    float au = dot(a, dpdu), av = dot(a, dpdv), inv = 1 / determinant;
    Vec2f d{(vv * au - uv * av) * inv, (uu * av - uv * au) * inv};
    return std::isfinite(d.x) && std::isfinite(d.y) ? d : Vec2f{0, 0};
}

} // namespace

TextureContext PathIntegrator::texture_context(const SurfacePoint& s) const {
    TextureContext c{.p = s.p, .n = s.ns, .uv = s.uv, .dpdx = {}, .dpdy = {}, .duvdx = {}, .duvdy = {}};
    Camera::Footprint footprint = camera_->footprint(s.p, s.ng, footprint_scale_);
    c.dpdx = footprint.dpdx;
    c.dpdy = footprint.dpdy;
    c.duvdx = in_tangents(c.dpdx, s.dpdu, s.dpdv);
    c.duvdy = in_tangents(c.dpdy, s.dpdu, s.dpdv);
    return c;
}

float PathIntegrator::hit_weight(float bsdf_pdf, float light_pdf) const {
    if (!samples_lights()) return 1;
    if (settings_.strategy == Strategy::light) return light_pdf > 0 ? 0.0f : 1.0f;
    return weight(bsdf_pdf, light_pdf);
}

void PathIntegrator::add_met_light(const SceneView& scene, PathState& state, Index light, const LightHit& hit,
                                   PathRecorder recorder) const {
    const LightContext context{scene, light};
    const SampledSpectrum le = incident_radiance(context, state.previous, hit, state.lambda);
    if (is_black(le)) return;
    // Light sampling could have found it as well.
    const bool shared = !state.sees_lights;
    const float pdf = shared ? scene.light_sampler->probability(state.previous, light, hit.part) *
                                   pdf_li(context, state.previous, hit)
                             : 0;
    const float weight = shared ? hit_weight(state.bsdf_pdf, pdf) : 1;
    const bool counted = settings_.strategy != Strategy::mis_light;
    if (recorder)
        recorder.found_light({.light = light,
                              .part = hit.part,
                              .radiance = le,
                              .shared = shared,
                              .bsdf_pdf = shared ? state.bsdf_pdf : 0,
                              .light_pdf = pdf,
                              .weight = weight,
                              .counted = counted});
    if (counted) state.radiance += state.throughput * le * weight;
}

MONTELUX_ONE_COPY
void PathIntegrator::escape(const SceneView& scene, PathState& state, PathRecorder recorder) const {
    if (recorder) recorder.left_scene(state.ray, state.throughput);
    for (Index light : scene.light_tables.infinite_lights)
        add_met_light(scene, state, light, {.wi = state.ray.d}, recorder);
    if (recorder) recorder.ended(PathEnd::left_scene);
    state.alive = false;
}

template FilmContribution PathIntegrator::estimate(const SceneView&, RayTracer&, const CameraSample&,
                                                   SampleStream&, PathRecord*) const;

} // namespace montelux
