#include "montelux/render/passes.h"

#include <algorithm>
#include <bit>

namespace montelux {

namespace {

constexpr std::uint64_t longest_pass = 16;

} // namespace

SamplerSettings with_replicates(SamplerSettings settings) {
    if (settings.kind != SamplerKind::independent && settings.replicates < 2)
        settings.replicates = std::min(8u, settings.samples_per_pixel);
    return settings;
}

std::optional<SamplePass> next_pass(const SamplerSettings& settings, std::uint64_t begin) {
    const std::uint64_t n = settings.samples_per_pixel;
    if (begin >= n) return std::nullopt;
    // 1, 1, 2, 4, 8, 16, 16, ... samples.
    SamplePass pass{begin, begin + std::clamp<std::uint64_t>(std::bit_floor(begin), 1, longest_pass)};
    pass.end = std::min(pass.end, n);
    if (settings.kind == SamplerKind::independent) return pass;
    const std::uint64_t points = points_per_replicate(settings);
    const std::uint64_t replicate_end = std::min(n, (begin / points + 1) * points);
    pass.end = std::min(pass.end, replicate_end);
    pass.every_sample_is_a_unit = false;
    pass.ends_unit = pass.end == replicate_end;
    return pass;
}

} // namespace montelux
