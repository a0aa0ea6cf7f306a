#include "montelux/transport/path_integrator.h"

#include "montelux/mc/random/sample_stream.h"
#include "montelux/transport/guiding/guiding_trace.h"
#include "montelux/transport/path_shading.h"

namespace montelux {

void PathIntegrator::add_met_light(const SceneView& scene, PathState& state, Index light, const LightHit& hit,
                                   PathRecorder recorder) const {
    if (state.chain == ManifoldChain::joined && casters_->covers(light)) [[unlikely]]
        return;
    const LightContext context{scene, light, state.ray.time};
    const SampledSpectrum le = incident_radiance(context, state.previous, hit, state.lambda);
    if (is_black(le)) return;
    // Light sampling could have found it as well.
    const bool shared = !state.sees_lights;
    const float pdf = shared ? scene.light_sampler->probability(state.previous, light, hit.part) *
                                   pdf_li(context, state.previous, hit)
                             : 0;
    const float weight = shared ? hit_weight(settings_, state.bsdf_pdf, pdf) : 1;
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
    if (state.trace != nullptr && shared) [[unlikely]]
        state.trace->meet_light(
            state.throughput * le, weight,
            counted ? hit_weight(settings_, state.trace->unguided_pdf(state.bsdf_pdf), pdf) : weight);
    if (counted) state.add(state.throughput * le * weight, light);
}

void PathIntegrator::escape(const SceneView& scene, PathState& state, PathRecorder recorder) const {
    if (recorder) recorder.left_scene(state.ray, state.throughput);
    if (state.trace != nullptr) [[unlikely]]
        state.trace->arrive(state.radiance);
    state.leave(state.throughput);
    if (!settings_.background || state.depth > 0)
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
