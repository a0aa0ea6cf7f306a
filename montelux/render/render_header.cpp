#include "montelux/render/render_header.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "montelux/film/film_layers.h"
#include "montelux/image/cryptomatte.h"
#include "montelux/image/placement.h"
#include "montelux/render/checkpoint.h"
#include "montelux/render/integrator_choice.h"
#include "montelux/render/layer_sampler.h"
#include "montelux/render/sample_order.h"
#include "montelux/scene/setting_names.h"

namespace montelux {

namespace {

std::string hexadecimal(std::uint64_t hash) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

std::vector<float> numbers(std::initializer_list<int> values) {
    std::vector<float> v;
    for (const int x : values) v.push_back(static_cast<float>(x));
    return v;
}

} // namespace

void add_render_header(Image& image, const std::string& scene_name, const Renderer& renderer,
                       const RenderReport& report, const FilmError& error, double clamped_luminance) {
    const SceneDescription& description = renderer.description();
    const ContentDigest scene = renderer.scene_digest().whole();
    auto& a = image.attributes();
    a["software"] = std::string("Montelux " MONTELUX_VERSION);
    a["scene"] = scene_name;
    a["sceneHash"] = hexadecimal(scene.high) + hexadecimal(scene.low);
    a["renderHash"] = hexadecimal(render_fingerprint(renderer));
    a["spp"] = static_cast<int>(description.sampler.spp);
    a["stoppedBy"] = std::string(to_string(report.stop));
    const RenderTarget& target = renderer.target();
    if (target.error > 0) a["targetError"] = static_cast<float>(target.error);
    if (target.quantile > 0) a["targetQuantile"] = static_cast<float>(target.quantile);
    a["adaptive"] = target.adaptive ? 1 : 0;
    a["slice"] = std::to_string(target.slice.index + 1) + "/" + std::to_string(target.slice.count);
    a["pointsPerReplicate"] =
        static_cast<int>(SampleOrder(renderer.sampler(), target.slice).replicate_size());
    if (clamped_luminance > 0) {
        a["clampedLuminance"] = static_cast<float>(clamped_luminance);
        a["clampedSamples"] = static_cast<int>(std::min<std::uint64_t>(report.clamped_samples, 1u << 30));
    }
    a["samplesTaken"] = static_cast<float>(error.mean_samples);
    a["interrupted"] = report.cancelled() ? 1 : 0;
    a["sampler"] = std::string(name_of(description.sampler.kind));
    a["integrator"] = std::string(name_of(description.integrator.method));
    if (report.choice.decided) a["integratorChoice"] = choice_text(report.choice);
    if (description.integrator.method == IntegratorKind::metropolis) {
        const ChainStatistics& chains = report.chains;
        a["chainsPerReplicate"] = static_cast<int>(chains.chains);
        a["statesPerChain"] = static_cast<int>(std::min<std::uint64_t>(chains.states, 1u << 30));
        a["largeStepProbability"] = chains.large_step_probability;
        a["longestSmallStep"] = chains.longest_step;
        a["rHat"] = static_cast<float>(chains.agreement.worst_r_hat());
    }
    if (const MergingSummary& m = report.merging; m.first_radius > 0) {
        a["merging"] = std::string("consistent, not unbiased"); // by a bias that no standard error contains
        a["mergingFirstRadius"] = static_cast<float>(m.first_radius);
        a["mergingLastRadius"] = static_cast<float>(m.last_radius);
        a["mergingLightPaths"] = static_cast<int>(std::min<std::uint64_t>(m.light_paths, 1u << 30));
        if (m.passes >= 2 && error.mean_luminance > 0) { // relative to the mean luminance
            a["mergingBias"] = static_cast<float>(m.bias / error.mean_luminance);
            a["mergingBiasError"] = static_cast<float>(m.bias_error / error.mean_luminance);
            a["mergingBiasRms"] = static_cast<float>(m.bias_rms / error.mean_luminance);
        }
    }
    a["strategy"] = std::string(name_of(description.integrator.strategy));
    a["heuristic"] = std::string(name_of(description.integrator.heuristic));
    a["lightSampling"] = std::string(name_of(description.integrator.light_sampling));
    if (description.integrator.guiding != Guiding::off) {
        a["guiding"] = std::string(name_of(description.integrator.guiding));
        a["guided"] = report.guide.bytes > 0 ? 1 : 0;
        a["guideTrainingSamples"] = report.guide.samples;
    }
    if (description.integrator.manifold_sampling) a["manifoldSampling"] = 1;
    a["equiangular"] = description.integrator.equiangular ? 1 : 0;
    a["environmentSampling"] = std::string(name_of(description.integrator.environment_sampling));
    a["environmentCompensation"] = description.integrator.environment_compensation ? 1 : 0;
    a["environmentLookup"] = std::string(name_of(description.integrator.environment_lookup));
    if (description.integrator.regularize) a["regularize"] = 1; // a bias that no standard error contains
    if (description.integrator.occlusion) a["ambientOcclusion"] = 1;
    if (const std::optional<Vec3f>& color = description.integrator.background)
        a["background"] = std::vector<float>{color->x, color->y, color->z};
    a["microfacetScattering"] = std::string(name_of(description.integrator.microfacet_scattering));
    a["shadingTerminator"] = std::string(name_of(description.integrator.shading_terminator));
    a["maxDepth"] = description.integrator.max_depth;
    a["seed"] = std::to_string(description.sampler.seed);
    a["renderSeconds"] = static_cast<float>(report.seconds);
    a["relativeError"] = static_cast<float>(error.relative);
    a["badSamples"] = static_cast<int>(std::min<std::uint64_t>(report.bad.count(), 1u << 30));
    a["worldToCamera"] = renderer.camera().world_from_camera().inverse_matrix();
    const FilmSettings& film = description.film;
    if (film.layers.set != LayerSet::standard()) a["layers"] = text_of(film.layers.set);
    if (film.layers.in_camera_space) a["layerSpace"] = std::string("camera");
    if (film.layers.set.has(Layer::shape))
        add_cryptomatte_metadata(image, shape_matte, shape_id_names(description.scene));
    if (film.layers.set.has(Layer::material))
        add_cryptomatte_metadata(image, material_matte, material_id_names(description.scene));
    set_placement(image, film.crop.x0, film.crop.y0, {0, 0, film.width, film.height});
    a["fullResolution"] = numbers({film.width, film.height});
    a["cropPixels"] = numbers({film.crop.x0, film.crop.y0, film.crop.x1, film.crop.y1});
}

} // namespace montelux
