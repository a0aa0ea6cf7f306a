// How the samples of a picture are split into passes over the film.
#pragma once

#include <cstdint>
#include <vector>

#include "montelux/mc/random/sampler_settings.h"

namespace montelux {

// Samples [begin, end) of every pixel.
struct SamplePass {
    std::uint64_t begin = 0, end = 0;
    // Samples are independent of one another; else all samples of a pass form one unit of the error estimate.
    bool every_sample_is_a_unit = true;
};

// With `replicates` 0 or 1 and a quasi-random sampler: the number that suits. Eight give an error estimate
// with seven degrees of freedom and leave most samples to the point sets; with fewer than eight samples each
// stands alone.
SamplerSettings with_replicates(SamplerSettings settings);

// Covers [0, samples_per_pixel) in order. A quasi-random sampler has one pass a randomisation; the
// independent one starts with short passes, so that a first look comes early.
std::vector<SamplePass> sample_passes(const SamplerSettings& settings);

} // namespace montelux
