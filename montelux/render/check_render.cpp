#include "montelux/render/check_render.h"

#include <cmath>

#include "montelux/film/film_layers.h"
#include "montelux/mc/math/error.h"
#include "montelux/render/sample_allocation.h"
#include "montelux/scene/light_tracing_support.h"
#include "montelux/scene/setting_names.h"
#include "montelux/scene/view.h"

namespace montelux {
namespace {

void check_metropolis(const SceneDescription& d, const RenderTarget& target) {
    const auto refuse = [](const char* what) { throw Error("metropolis", what); };
    if (d.integrator.occlusion)
        refuse("ambient occlusion has no paths that chains could follow; render it by the integrator path");
    if (d.film.spectral) refuse("a spectral film is not supported; render it by the integrator path");
    if (film_layers_of(d).sums() > 0)
        refuse(
            "of the layers only the standard ones, variance and relative-variance are supported; render the "
            "others by the integrator path");
    if (target.adaptive)
        refuse("chains choose themselves where they take samples; render without adaptive allocation");
    if (const float p = d.integrator.large_step_probability; !(p >= 0 && p <= 1))
        refuse("the probability of large steps must be between 0 (chosen automatically) and 1");
}

// What a film filled by light paths cannot have.
void check_light_tracing(const SceneDescription& d, const RenderTarget& target) {
    const std::string where = "integrator " + std::string(name_of(d.integrator.method));
    if (const auto obstacle = light_tracing_obstacle(d.scene, d.integrator))
        throw Error(where, *obstacle + "; choose 'path'");
    if (target.adaptive)
        throw Error(where,
                    "its light paths reach all pixels at once: samples cannot be allocated to single ones; "
                    "leave out --adaptive or choose 'path'");
    if (d.integrator.merging && d.integrator.method == IntegratorKind::bidirectional) {
        if (const float r = d.integrator.merging->radius; !(r >= 0 && std::isfinite(r)))
            throw Error("merging", "the radius must be positive and finite, or 0 to be chosen automatically");
        if (d.integrator.merging->memory < 1) throw Error("merging", "the memory must be at least 1 MiB");
    }
    if (d.film.spectral) throw Error(where, "a spectral film cannot be rendered by it; choose 'path'");
    for (const Layer layer : {Layer::direct, Layer::indirect, Layer::light_groups})
        if (d.film.layers.set.has(layer))
            throw Error(where,
                        "the parts of the light (layers direct, indirect, light-groups) cannot be rendered "
                        "by it; choose 'path'");
}

// Of a method that cannot merge.
void check_merging(const SceneDescription& d) {
    if (d.integrator.merging && d.integrator.method != IntegratorKind::bidirectional)
        throw Error("merging", "only the integrator 'bidirectional' merges paths, not '" +
                                   std::string(name_of(d.integrator.method)) +
                                   "': choose it, or leave merging out");
}

void check_manifold_sampling(const SceneDescription& d) {
    const IntegratorSettings& s = d.integrator;
    if (!s.manifold_sampling) return;
    const auto refuse = [](const std::string& what) {
        throw Error("manifold sampling", what + "; leave manifold sampling off");
    };
    if (s.method != IntegratorKind::path)
        refuse("only the integrator 'path' has it, not '" + std::string(name_of(s.method)) + "'");
    if (s.occlusion) refuse("ambient occlusion is no light");
    if (s.guiding != Guiding::off) refuse("paths that learn where light comes from cannot be joined by it");
    if (s.strategy != Strategy::mis) refuse("it needs the strategy 'mis'");
    if (s.regularize) refuse("regularization makes smooth surfaces rough after a diffuse vertex");
    if (s.shading_terminator == ShadingTerminator::soft)
        refuse("the soft shading terminator is not supported");
    if (SceneView(d.scene).has_media()) refuse("scenes with media or interfaces are not supported");
}

} // namespace

SamplerSettings sampler_of(const SceneDescription& description) {
    SamplerSettings sampler = description.sampler;
    sampler.chains = description.integrator.method == IntegratorKind::metropolis;
    return sampler;
}

void check_render(const SceneDescription& d, const SamplerSettings& sampler, const RenderTarget& target) {
    if (d.integrator.method == IntegratorKind::automatic)
        throw Error(
            "integrator auto",
            "it is chosen at the start of a whole picture; here choose path, bidirectional or metropolis");
    if (d.sampler.spp < 1) throw Error("sampler", "at least 1 sample per pixel is needed");
    check_slice(sampler, target);
    if (d.film.spectral && target.slice.count > 1)
        throw Error("film",
                    "a spectral film cannot be rendered in slices: merge has no layers of wavelengths");
    if (target.slice.count > 1 && d.film.layers.set != LayerSet::standard())
        throw Error("slice", "slices are joined by their standard layers; no others can be chosen");
    if (d.integrator.occlusion && d.film.layers.set.has(Layer::light_groups))
        throw Error("film", "ambient occlusion is no light of the scene: 'light-groups' cannot be chosen");
    check_merging(d);
    check_manifold_sampling(d);
    if (d.integrator.method == IntegratorKind::metropolis) check_metropolis(d, target);
    if (traces_light(d.integrator.method)) check_light_tracing(d, target);
}

} // namespace montelux
