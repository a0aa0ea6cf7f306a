// How the samples of a picture are split into passes over the film.
#pragma once

#include <cstdint>
#include <optional>

#include "montelux/mc/random/sampler_settings.h"

namespace montelux {

// Samples [begin, end) of every pixel.
struct SamplePass {
    std::uint64_t begin = 0, end = 0;
    // Samples are independent of one another; else all samples of a replicate form one unit of the error
    // estimate.
    bool every_sample_is_a_unit = true;
    // The last pass of a replicate.
    bool ends_unit = true;
};

// With `replicates` 0 or 1 and a quasi-random sampler: the number that suits. Eight give an error estimate
// with seven degrees of freedom and leave most samples to the point sets; with fewer than eight samples each
// stands alone.
SamplerSettings with_replicates(SamplerSettings settings);

// The pass that starts at sample `begin`; empty when all samples_per_pixel have been taken. The first passes
// are short, so that a first look comes early, and none is long, so that a render can be stopped; none spans
// two replicates.
std::optional<SamplePass> next_pass(const SamplerSettings& settings, std::uint64_t begin);

} // namespace montelux
