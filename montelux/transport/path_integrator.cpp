#include "montelux/transport/path_integrator.h"

#include <cmath>

#include "montelux/mc/random/sample_stream.h"
#include "montelux/transport/path_shading.h"

namespace montelux {

namespace {

// Finds (x, y) such that a = x dpdu + y dpdv in the least-squares sense; zero for degenerate tangents.
class TangentSolver {
  public:
    TangentSolver(Vec3f dpdu, Vec3f dpdv)
        : dpdu_(dpdu), dpdv_(dpdv), uu_(dot(dpdu, dpdu)), uv_(dot(dpdu, dpdv)), vv_(dot(dpdv, dpdv)) {
        const float determinant = uu_ * vv_ - uv_ * uv_;
        inverse_ = std::abs(determinant) > 0 ? 1 / determinant : 0;
    }

    Vec2f operator()(Vec3f a) const {
        const float au = dot(a, dpdu_), av = dot(a, dpdv_);
        const Vec2f d{(vv_ * au - uv_ * av) * inverse_, (uu_ * av - uv_ * au) * inverse_};
        return std::isfinite(d.x) && std::isfinite(d.y) ? d : Vec2f{0, 0};
    }

  private:
    Vec3f dpdu_, dpdv_;
    float uu_, uv_, vv_, inverse_;
};

} // namespace

TextureContext PathIntegrator::texture_context(const SurfacePoint& s) const {
    const Camera::Footprint footprint = camera_->footprint(s.p, s.ng, footprint_scale_);
    const TangentSolver in_tangents(s.dpdu, s.dpdv);
    return {.p = s.p,
            .n = s.ns,
            .uv = s.uv,
            .dpdx = footprint.dpdx,
            .dpdy = footprint.dpdy,
            .duvdx = in_tangents(footprint.dpdx),
            .duvdy = in_tangents(footprint.dpdy)};
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

void PathIntegrator::escape(const SceneView& scene, PathState& state, PathRecorder recorder) const {
    if (recorder) recorder.left_scene(state.ray, state.throughput);
    for (Index light : scene.light_tables.infinite_lights)
        add_met_light(scene, state, light, {.wi = state.ray.d}, recorder);
    if (recorder) recorder.ended(PathEnd::left_scene);
    state.alive = false;
}

template FilmContribution PathIntegrator::estimate(const SceneView&, RayTracer&, const CameraSample&,
                                                   SampleStream&, PathRecord*) const;
template void PathIntegrator::estimate(const SceneView&, RayTracer&, std::span<PathStart<SampleStream>>,
                                       PathBatch&, std::span<FilmContribution>) const;

} // namespace montelux
