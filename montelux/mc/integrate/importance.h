// Importance sampling: the mean of f / p over points that follow any density p.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "montelux/mc/integrate/sample_loop.h"
#include "montelux/mc/integrate/technique.h"

namespace montelux {

// f(x) / p(x); a sample where both are zero contributes zero. A sample with f != 0 but p = 0 contradicts
// its own density: the quotient is infinite, and so is counted among the non-finite ones.
template <typename F, SamplingTechnique S, std::size_t D = S::dimensions>
double importance_weighted(const F& f, const S& technique, const std::array<double, D>& xi) {
    auto x = technique.sample(xi);
    double y = f(x);
    return y == 0 ? 0 : y / technique.pdf(x);
}

// The estimator 1/N * sum of f(X_i) / p(X_i), X_i ~ p. `technique` is a SamplingTechnique, a Distribution1D
// (X = P^-1(xi)) or a ProductDistribution. p must be above zero wherever f is not zero: the part of the
// integral where it is not is missing from the value *and* from the standard error, and no sample can tell.
// `find_uncovered` looks for such places.
template <typename F, typename Technique>
Estimate importance_sampling(const F& f, const Technique& technique,
                             const MonteCarloSettings& settings = {}) {
    auto s = as_technique(technique);
    return sum_samples(settings.samples,
                       [&](std::uint64_t i) {
                           auto xi = sample_uniforms<decltype(s)::dimensions>(settings.seed, 0, i);
                           return importance_weighted(f, s, xi);
                       })
        .estimate();
}

// Probes f and p at uniform points of [a, b] and gives the first with f != 0 where p = 0, which makes
// importance sampling of f by p biased; empty when no probe finds one.
template <typename F, Distribution1D Density>
std::optional<double> find_uncovered(const F& f, const Density& p, double a, double b, int probes = 4096) {
    for (int i = 0; i < probes; ++i) {
        double x = a + (b - a) * (i + 0.5) / probes;
        double y = f(x);
        if (y != 0 && !(p.pdf(x) > 0)) return x;
    }
    return std::nullopt;
}

} // namespace montelux
