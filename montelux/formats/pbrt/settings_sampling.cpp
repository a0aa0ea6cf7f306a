#include <algorithm>
#include <array>
#include <cstdint>

#include "montelux/formats/pbrt/coverage.h"
#include "montelux/formats/pbrt/parameter_reader.h"
#include "montelux/formats/pbrt/settings.h"
#include "montelux/scene/light_tracing_support.h"

namespace montelux::pbrt {
namespace {

std::uint32_t read_count(ParameterReader& r, std::string_view name, int otherwise) {
    int n = r.integer(name, otherwise);
    if (n <= 0)
        r.error(name,
                "parameter " + in_quotes(name) + " is " + std::to_string(n) + "; expected at least 1 sample");
    return static_cast<std::uint32_t>(n);
}

// What the path tracer does in place of another integrator.
std::string_view substitute_of(std::string_view integrator) {
    if (integrator == "function")
        return "it integrates test functions and no scene; the scene is rendered with 'path'";
    if (integrator == "simplevolpath")
        return "the scene is rendered with 'volpath', which computes the same picture with less noise";
    // sppm
    return "the scene is rendered with 'path', which computes the same picture; caustics of small lights are "
           "noisier";
}

} // namespace

SamplerSettings read_sampler(const Plugin& plugin, Diagnostics& diagnostics, std::uint64_t seed) {
    ParameterReader r(plugin.parameters, "sampler " + in_quotes(plugin.name), plugin.at, diagnostics);
    SamplerSettings s;
    s.seed = seed;
    if (std::optional<int> own = r.integer("seed")) s.seed = static_cast<std::uint32_t>(*own);
    if (plugin.name == "stratified") {
        s.kind = SamplerKind::stratified;
        std::uint64_t count = std::uint64_t{read_count(r, "xsamples", 4)} * read_count(r, "ysamples", 4);
        if (count > INT32_MAX) r.error("xsamples", "more than 2147483647 samples");
        s.spp = static_cast<std::uint32_t>(count);
        if (!r.boolean("jitter", true))
            diagnostics.warn(r.at("jitter"), "samples are always jittered within their strata");
        r.finish();
        return s;
    }
    if (plugin.name == "independent") {
        s.kind = SamplerKind::independent;
        s.spp = read_count(r, "pixelsamples", 4);
        r.finish();
        return s;
    }
    if (plugin.name == "halton") {
        s.kind = SamplerKind::halton;
    } else if (plugin.name == "sobol" || plugin.name == "paddedsobol") {
        s.kind = SamplerKind::sobol;
    } else if (plugin.name == "zsobol" || plugin.name == "pmj02bn") {
        s.kind = SamplerKind::sobol_blue_noise;
    } else {
        r.error("unknown sampler " + in_quotes(plugin.name) + plugin_suggestion("Sampler", plugin.name));
    }
    s.spp = read_count(r, "pixelsamples", 16);
    if (plugin.name == "pmj02bn") {
        diagnostics.warn(plugin.at, "sampler 'pmj02bn' is rendered with Sobol' points of blue-noise error");
    } else {
        std::string_view randomization =
            r.choice("randomization", {"none", "permutedigits", "fastowen", "owen"}, "owen");
        if (randomization == "none")
            diagnostics.warn(r.at("randomization"), "the points are randomised all the same: without it the "
                                                    "error cannot be estimated");
    }
    r.finish();
    return s;
}

namespace {

// Those of Montelux that pbrt-v4 does not know.
void read_own_settings(ParameterReader& r, IntegratorSettings& s) {
    s.count_passages = r.boolean("countpassages", true);
    if (r.choice("environmentlookup", {"nearest", "bilinear"}, "nearest") == "bilinear")
        s.environment_lookup = EnvironmentLookup::bilinear;
    if (r.choice("microfacetscattering", {"single", "multiple"}, "single") == "multiple")
        s.microfacet_scattering = MicrofacetScattering::multiple;
    if (r.choice("shadingterminator", {"hard", "soft"}, "hard") == "soft")
        s.shading_terminator = ShadingTerminator::soft;
    const std::vector<Vec3f> background = r.triples("background", ParameterType::rgb);
    if (background.size() > 1)
        r.error("background",
                "parameter 'background' has " + std::to_string(background.size()) + " colours; expected 1");
    if (!background.empty()) s.background = background[0];
}

} // namespace

IntegratorSettings read_integrator(const Plugin& plugin, Diagnostics& diagnostics,
                                   std::optional<std::uint32_t>& samples) {
    ParameterReader r(plugin.parameters, "integrator " + in_quotes(plugin.name), plugin.at, diagnostics);
    IntegratorSettings s;
    if (plugin.name == "ambientocclusion" || plugin.name == "ao") {
        OcclusionSettings o;
        o.cosine = r.boolean("cossample", true);
        o.max_distance = r.number("maxdistance", o.max_distance);
        if (!(o.max_distance > 0)) r.error("maxdistance", "parameter 'maxdistance' must be positive");
        s.occlusion = o;
        r.finish();
        return s;
    }
    s.max_depth = r.integer("maxdepth", 5);
    if (s.max_depth < 0) r.error("maxdepth", "parameter 'maxdepth' is negative");
    if (plugin.name == "path" || plugin.name == "volpath") {
        s.regularize = r.boolean("regularize", false);
        if (s.regularize)
            diagnostics.warn(r.at("regularize"),
                             "'regularize' widens the reflections of indirect light: the picture "
                             "is biased, and its standard errors do not contain the bias");
        const std::string_view lights =
            r.choice("lightsampler", {"uniform", "power", "bvh", "exhaustive"}, "");
        if (lights == "uniform") s.light_sampling = LightSampling::uniform;
        if (lights == "power") s.light_sampling = LightSampling::power;
        if (lights == "exhaustive")
            diagnostics.warn_once("lightsampler", r.at("lightsampler"),
                                  "lights are chosen by a tree, as with 'bvh'; it changes the noise alone");
        read_own_settings(r, s);
        r.finish();
    } else if (plugin.name == "simplepath") {
        bool lights = r.boolean("samplelights", true);
        bool bsdf = r.boolean("samplebsdf", true);
        s.strategy = lights ? Strategy::light : bsdf ? Strategy::bsdf : Strategy::uniform;
        if (lights && !bsdf)
            diagnostics.warn(r.at("samplebsdf"),
                             "BSDFs are sampled all the same; it changes the noise alone");
        r.finish();
    } else if (plugin.name == "bdpt" || plugin.name == "lightpath") {
        s.method = plugin.name == "bdpt" ? IntegratorKind::bidirectional : IntegratorKind::light_tracing;
        if (s.method == IntegratorKind::light_tracing)
            diagnostics.warn(plugin.at, std::string(light_tracing_warning));
        else if (r.boolean("regularize", false))
            diagnostics.warn(r.at("regularize"),
                             "'regularize' is ignored: light is joined with unchanged surfaces");
    } else if (plugin.name == "mlt") {
        s.method = IntegratorKind::metropolis;
        samples = read_count(r, "mutationsperpixel", 100);
        s.large_step_probability = r.number("largestepprobability", 0);
        if (!(s.large_step_probability >= 0 && s.large_step_probability <= 1))
            r.error("largestepprobability", "parameter 'largestepprobability' must be between 0 and 1");
        s.regularize = r.boolean("regularize", false);
        for (const char* name : {"chains", "bootstrapsamples", "sigma"})
            if (r.ignored(name) != nullptr)
                diagnostics.warn(r.at(name),
                                 "parameter " + in_quotes(name) +
                                     " is ignored: it is chosen for each scene, and changes the noise alone");
        read_own_settings(r, s);
        r.finish();
    } else if (plugin.name == "randomwalk") {
        s.strategy = Strategy::uniform;
        r.finish();
    } else if (is_plugin("Integrator", plugin.name)) {
        diagnostics.warn(plugin.at, "integrator " + in_quotes(plugin.name) + ": " +
                                        std::string(substitute_of(plugin.name)));
    } else {
        r.error("unknown integrator " + in_quotes(plugin.name) +
                plugin_suggestion("Integrator", plugin.name));
    }
    return s;
}

} // namespace montelux::pbrt
