// The loop that every estimator runs: values keyed by sample index, summed in parallel in a fixed order.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/philox_stream.h"
#include "montelux/mc/stats/estimate.h"
#include "montelux/mc/stats/moments.h"

namespace montelux {

struct MonteCarloSettings {
    std::uint64_t samples = 1 << 16;
    std::uint64_t seed = 0;
};

// The uniform numbers of one sample, a pure function of seed, stream and index. Estimators that share a
// seed draw the same numbers for the same index; streams tell the techniques of one estimator apart.
template <std::size_t D>
std::array<double, D> sample_uniforms(std::uint64_t seed, std::uint32_t stream, std::uint64_t index) {
    PhiloxStream numbers(
        hash_key(seed), {static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32), stream});
    std::array<double, D> xi;
    for (double& x : xi) x = numbers.next_double();
    return xi;
}

// Moments of sample values; those that are not finite count as zero, and are counted.
struct SampleSum {
    RunningMoments moments;
    std::uint64_t non_finite = 0;
    std::uint64_t first_non_finite = Estimate::no_index;

    void add(double value, std::uint64_t index) {
        if (!std::isfinite(value)) {
            ++non_finite;
            first_non_finite = std::min(first_non_finite, index);
            value = 0;
        }
        moments.add(value);
    }
    void merge(const SampleSum& other) {
        moments.merge(other.moments);
        non_finite += other.non_finite;
        first_non_finite = std::min(first_non_finite, other.first_non_finite);
    }
    Estimate estimate() const { return Estimate::from_moments(moments, non_finite, first_non_finite); }
};

// value(i) for each i in [0, count), on all threads; the sum does not depend on how many there are. The
// first exception of `value` is rethrown.
template <typename Value>
SampleSum sum_samples(std::uint64_t count, const Value& value) {
    if (count == 0) throw Error("expected at least one sample");
    constexpr std::uint64_t run = 4096;
    auto runs = static_cast<std::int64_t>((count + run - 1) / run);
    return parallel_reduce_ordered(
        runs,
        [&](std::int64_t r) {
            std::uint64_t begin = static_cast<std::uint64_t>(r) * run, end = std::min(count, begin + run);
            SampleSum sum;
            for (std::uint64_t i = begin; i < end; ++i) sum.add(value(i), i);
            return sum;
        },
        [](SampleSum a, const SampleSum& b) {
            a.merge(b);
            return a;
        });
}

} // namespace montelux
