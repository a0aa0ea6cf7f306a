#include "montelux/render/render_warnings.h"

#include <cmath>

#include "montelux/render/sample_order.h"

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

std::string missing_error_warning(const RenderSnapshot& result, const Renderer& renderer) {
    if (renderer.target().slice.count > 1) return {};
    const std::uint64_t points = SampleOrder(renderer.sampler(), renderer.target().slice).replicate_size();
    if (std::isfinite(result.error.relative) || result.error.mean_samples < 2 || points < 2) return {};
    return "the errors are unknown: fewer than two replicates of " + std::to_string(points) +
           " samples per pixel are complete; a time limit or a target error makes them short";
}

} // namespace montelux
