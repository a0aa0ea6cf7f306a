// Randomised quasi-Monte Carlo: low-discrepancy points, with an honest error from independent replicates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "montelux/mc/integrate/sample_loop.h"
#include "montelux/mc/integrate/technique.h"

namespace montelux {

struct QuasiSettings {
    std::uint64_t points = 4096;   // of each replicate
    std::uint32_t replicates = 16; // independent randomisations; at least 2 for an error
};

// The mean over replicates of 1/N * sum of f(X_i) / p(X_i), where X_i comes from the i-th point of the unit
// cube of that replicate: point(i, replicate) -> std::array<double, D> in [0, 1)^D, D the dimensions of the
// technique. Each point must be uniform over randomisations, so that the estimate is unbiased, and replicates
// must be independent: their spread gives the standard error (Owen 2013, "Monte Carlo theory, methods and
// examples", section 17). It has replicates - 1 degrees of freedom, so with few of them intervals follow
// Student's law.
template <typename F, typename Technique, typename PointSet>
Estimate randomised_quasi_monte_carlo(const F& f, const Technique& technique, const PointSet& point,
                                      const QuasiSettings& settings = {}) {
    auto s = as_technique(technique);
    constexpr std::size_t dimensions = decltype(s)::dimensions;
    if (settings.points == 0 || settings.replicates == 0)
        throw Error("randomised_quasi_monte_carlo", "expected at least one point and one replicate");
    RunningMoments replicates;
    Estimate total;
    for (std::uint32_t r = 0; r < settings.replicates; ++r) {
        SampleSum sum = sum_samples(settings.points, [&](std::uint64_t i) {
            const std::array<double, dimensions> xi = point(i, r);
            auto x = s.sample(xi);
            double y = f(x);
            return y == 0 ? 0 : y / s.pdf(x);
        });
        replicates.add(sum.moments.mean());
        total.evaluations += settings.points;
        if (sum.non_finite > 0 && total.non_finite == 0)
            total.first_non_finite = r * settings.points + sum.first_non_finite;
        total.non_finite += sum.non_finite;
    }
    total.value = replicates.mean();
    total.standard_error = replicates.standard_error();
    return total;
}

// Rank-1 points shifted at random modulo 1 (Cranley and Patterson 1976, "Randomization of Number Theoretic
// Methods for Multiple Integration"): the shift of `replicate`, uniform in the unit cube.
template <std::size_t D>
std::array<double, D> random_shift(std::array<double, D> point, std::uint64_t seed, std::uint32_t replicate) {
    std::array<double, D> shift = sample_uniforms<D>(seed, 0xffffffffu, replicate);
    for (std::size_t d = 0; d < D; ++d) {
        point[d] += shift[d];
        if (point[d] >= 1) point[d] -= 1;
    }
    return point;
}

} // namespace montelux
