#include "montelux/render/passes.h"

#include <algorithm>

namespace montelux {

SamplerSettings with_replicates(SamplerSettings settings) {
    if (settings.kind != SamplerKind::independent && settings.replicates < 2)
        settings.replicates = std::min(8u, settings.samples_per_pixel);
    return settings;
}

std::vector<SamplePass> sample_passes(const SamplerSettings& settings) {
    const std::uint64_t n = settings.samples_per_pixel;
    std::vector<SamplePass> passes;
    if (settings.kind == SamplerKind::independent) {
        std::uint64_t length = 1;
        for (std::uint64_t begin = 0; begin < n; length = std::min<std::uint64_t>(2 * length, 16)) {
            std::uint64_t end = std::min(n, begin + length);
            passes.push_back({begin, end, true});
            begin = end;
        }
        return passes;
    }
    std::uint64_t begin = 0;
    for (std::uint64_t i = 1; i <= n; ++i)
        if (i == n || replicate_of(settings, i) != replicate_of(settings, begin)) {
            passes.push_back({begin, i, false});
            begin = i;
        }
    return passes;
}

} // namespace montelux
