#include "montelux/render/render_warnings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <vector>

#include "montelux/render/sample_order.h"
#include "montelux/scene/light/light.h"
#include "montelux/transport/manifold/casters.h"

namespace montelux {

std::string bad_sample_warning(const BadSampleReport& bad, std::uint64_t seed) {
    if (bad.count() == 0) return {};
    const char* kind = bad.first->kind == BadSample::Kind::nan        ? "not a number"
                       : bad.first->kind == BadSample::Kind::infinite ? "infinite"
                                                                      : "negative";
    auto text = [](auto n) { return std::to_string(n); };
    return text(bad.count()) + " samples were left out (" + text(bad.nan) + " not a number, " +
           text(bad.infinite) + " infinite, " + text(bad.negative) + " negative); the first, " + kind +
           ", is sample " + text(bad.first->sample) + " of pixel " + text(bad.first->x) + "," +
           text(bad.first->y) + " with seed " + text(seed);
}

std::string manifold_warning(const Renderer& renderer) {
    if (!renderer.description().integrator.manifold_sampling) return {};
    const Casters casters(renderer.scene());
    if (!casters.empty()) return {};
    return std::string("manifold sampling has no effect: ") +
           (casters.all().empty() ? "no shape is a smooth mirror or smooth glass of the kinds that it covers"
                                  : "no light is of the kinds that it covers");
}

std::string chain_warning(const ChainStatistics& chains) {
    if (chains.groups == 0) return {};
    const auto text = [](std::uint64_t n) { return std::to_string(n); };
    if (chains.dark_groups == chains.groups)
        return "no chain found light to start from among " + text(chains.groups * chains.starting_points) +
               " independent paths: the picture contains only what such paths find, and its errors know no "
               "other "
               "light";
    if (chains.dark_groups > 0)
        return text(chains.dark_groups) + " of " + text(chains.groups) +
               " groups of chains found no light to start from; more samples per pixel make them larger";
    constexpr double accepted = 1.1;
    const double r_hat = chains.agreement.worst_r_hat();
    if (chains.groups < 2 || !(r_hat > accepted)) return {};
    char number[32];
    std::snprintf(number, sizeof number, "%.2f", r_hat);
    return std::string("groups of chains differ more than their lengths explain (R-hat ") + number +
           ", expected at most 1.10): light that few of them found may be missing from the errors; more "
           "samples "
           "per pixel make them longer";
}

std::string merging_notice(const RenderSnapshot& result, const RenderTarget& target) {
    const MergingSummary& m = result.report.merging;
    if (!(m.first_radius > 0) || m.bytes == 0) return {};
    char text[240];
    std::snprintf(text, sizeof text,
                  "consistent, not unbiased: light within %.3g to %.3g of a point counts as at it; ",
                  m.first_radius, m.last_radius);
    std::string notice = text;
    const double mean = result.error.mean_luminance;
    if (m.passes < 2 || !(mean > 0)) {
        notice += "the bias is not known: a second replicate tells it";
    } else {
        std::snprintf(
            text, sizeof text,
            "estimated bias %.2g +- %.2g %% of the picture's mean, %.2g %% (rms) of it over 16 x 16 pixels",
            100 * m.bias / mean, 100 * m.bias_error / mean, 100 * m.bias_rms / mean);
        notice += text;
    }
    return notice +
           (target.error > 0 ? "; the target error covers noise alone" : "; the errors cover noise alone");
}

std::string merging_warning(const MergingSummary& m) {
    if (m.first_radius > 0 && m.bytes == 0)
        return "merging has no effect: no light path reached a surface that is no mirror or smooth glass "
               "by way of another surface";
    if (m.light_paths >= m.of_paths) return {};
    char text[200];
    std::snprintf(text, sizeof text,
                  "only %llu of %llu light paths of a pass fit into the memory for merging; a larger "
                  "--merging-memory takes more",
                  static_cast<unsigned long long>(m.light_paths),
                  static_cast<unsigned long long>(m.of_paths));
    return text;
}

std::string missing_error_warning(const RenderSnapshot& result, const Renderer& renderer) {
    if (renderer.target().slice.count > 1) return {};
    const std::uint64_t points = SampleOrder(renderer.sampler(), renderer.target().slice).replicate_size();
    if (std::isfinite(result.error.relative) || result.error.mean_samples < 2 || points < 2) return {};
    return "the errors are unknown: fewer than two replicates of " + std::to_string(points) +
           " samples per pixel are complete; a time limit or a target error makes them short";
}

std::string missing_light_warning(const RenderSnapshot& result, const RenderTarget& target,
                                  const SceneDescription& description) {
    if (!result.missing || !result.missing->matters(target.error)) return {};
    const MissingLight& missing = *result.missing;
    char share[32];
    std::snprintf(share, sizeof share, "%.2g %%", 100 * missing.share);
    const bool never = 2 * missing.never > missing.share;
    std::string from;
    if (missing.light != no_index) {
        const auto name = [](const auto& light) { return std::string(light.name); };
        from = " of the " + std::visit(name, description.scene.lights[missing.light]);
    }
    const bool soft = description.integrator.shading_terminator == ShadingTerminator::soft;
    return "about " + std::string(share) + " of the light " +
           (never ? "is missing" : "is missing, or in fireflies") + ": path tracing " +
           (never ? "cannot find" : "hardly finds") + " light" + from +
           " by way of smooth surfaces; --integrator bidirectional --merging auto" +
           (soft ? " --shading-terminator hard finds it" : " finds it");
}

std::string black_warning(const Image& picture, double spp, const Scene& scene) {
    constexpr double enough_samples = 8;
    const std::optional<int> depth = picture.find_channel("depth.Z");
    const std::vector<int> colors = picture.color_channels();
    if (!depth || spp < enough_samples) return {};
    std::size_t surfaces = 0, black = 0;
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x) {
            const float z = picture.value(x, y, *depth);
            if (!(z > 0 && std::isfinite(z))) continue;
            ++surfaces;
            black += std::ranges::all_of(colors, [&](int c) { return picture.value(x, y, c) == 0; }) ? 1 : 0;
        }
    if (2 * black <= surfaces || scene.lights.empty()) return {}; // without lights the scene's reader warns
    const bool lit_all_around = std::ranges::any_of(
        scene.lights, [](const Light& light) { return kind_of(light) == LightKind::infinite; });
    return lit_all_around ? "most of what the camera sees is black: light hardly finds its way there "
                            "(--integrator auto looks for a better one)"
                          : "most of what the camera sees is black: nothing lights the scene all around "
                            "(--environment studio does)";
}

} // namespace montelux
