// Basic Monte Carlo: the mean of an integrand over uniform points of an interval or a box.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "montelux/mc/integrate/sample_loop.h"

namespace montelux {

// The estimator (b - a) / N * sum of f(X_i). f(double) -> double; called from several threads.
template <typename F>
Estimate basic_monte_carlo(const F& f, double a, double b, const MonteCarloSettings& settings = {}) {
    if (!std::isfinite(b - a)) throw Error("basic_monte_carlo", "expected a finite interval");
    return sum_samples(settings.samples,
                       [&](std::uint64_t i) {
                           std::array<double, 1> xi = sample_uniforms<1>(settings.seed, 0, i);
                           return (b - a) * f(a + (b - a) * xi[0]);
                       })
        .estimate();
}

// The same over the box [lower, upper]: V / N * sum of f(X_i). f(std::array<double, D>) -> double.
template <std::size_t D, typename F>
Estimate basic_monte_carlo(const F& f, const std::array<double, D>& lower, const std::array<double, D>& upper,
                           const MonteCarloSettings& settings = {}) {
    double volume = 1;
    for (std::size_t d = 0; d < D; ++d) volume *= upper[d] - lower[d];
    if (!std::isfinite(volume)) throw Error("basic_monte_carlo", "expected a finite box");
    return sum_samples(settings.samples,
                       [&](std::uint64_t i) {
                           std::array<double, D> x = sample_uniforms<D>(settings.seed, 0, i);
                           for (std::size_t d = 0; d < D; ++d) x[d] = lower[d] + (upper[d] - lower[d]) * x[d];
                           return volume * f(x);
                       })
        .estimate();
}

} // namespace montelux
