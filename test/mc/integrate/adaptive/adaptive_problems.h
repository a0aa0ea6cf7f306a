// Integrals that the method Adaptive is tried on, one for each of its ways.
#pragma once

#include "test/mc/integrate/estimator_checks.h"
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "montelux/mc/math/constants.h"

namespace montelux {

// prod exp(-c_d x_d).
inline KnownIntegral smooth() {
    auto f = [](std::span<const double> x) { return std::exp(-x[0] - 2 * x[1] - 3 * x[2]); };
    double truth = 1;
    for (double c : {1.0, 2.0, 3.0}) truth *= -std::expm1(-c) / c;
    return {f, Domain::unit_cube(3), {truth}};
}
// Hardly varies: what uniform points are best at.
inline KnownIntegral flat() {
    auto f = [](std::span<const double> x) { return 1 + x[0] * x[1] * x[2]; };
    return {f, Domain::unit_cube(3), {1.125}};
}
// A box that is cut off.
inline KnownIntegral discontinuous() {
    auto f = [](std::span<const double> x) {
        return x[0] < 0.37 && x[1] < 0.61 ? std::exp(x[0] + x[1] + x[2]) : 0.0;
    };
    return {f, Domain::unit_cube(3), {std::expm1(0.37) * std::expm1(0.61) * std::expm1(1.0)}};
}
// Gaussians of standard deviation 0.07 at 0.3 and 0.7 of the diagonal, each with an integral of about 1.
inline double two_peaks_at(std::span<const double> x, double narrowness) {
    double sum = 0;
    for (double p : {0.3, 0.7}) {
        double squares = 0;
        for (double v : x) squares += (v - p) * (v - p);
        sum += std::exp(-narrowness * squares);
    }
    return sum * std::pow(narrowness / pi, 0.5 * static_cast<double>(x.size()));
}
inline KnownIntegral two_peaks(int dimensions, double narrowness = 100) {
    const double root = std::sqrt(narrowness);
    const double one = 0.5 * (std::erf(0.3 * root) + std::erf(0.7 * root)); // of one coordinate
    return {[narrowness](std::span<const double> x) { return two_peaks_at(x, narrowness); },
            Domain::unit_cube(dimensions),
            {2 * std::pow(one, dimensions)}};
}
// A Gaussian ridge along Rosenbrock's curved valley, in four variables.
inline double rosenbrock_ridge(std::span<const double> x) {
    double exponent = 0;
    for (std::size_t d = 0; d + 1 < x.size(); ++d) {
        const double off = x[d + 1] - x[d] * x[d];
        exponent += (1 - x[d]) * (1 - x[d]) + 100 * off * off;
    }
    return std::exp(-exponent);
}
// The massless two-loop propagator at p^2 = 1 over four Feynman parameters, the fifth being 1: singular at
// corners where several of them vanish together.
inline KnownIntegral two_loop_propagator() {
    auto f = [](std::span<const double> y) {
        const double u = (y[0] + y[1]) * (y[2] + 1) + y[3] * (y[0] + y[1] + y[2] + 1);
        const double v =
            y[0] * y[1] * (y[2] + 1 + y[3]) + y[2] * (y[0] + y[1] + y[3]) + y[0] * y[3] + y[1] * y[2] * y[3];
        return 1 / (u * v);
    };
    const double infinity = std::numeric_limits<double>::infinity();
    return {f, Domain(std::vector<Range>(4, {0, infinity})), {6 * 1.2020569031595942}}; // 6 zeta(3)
}

} // namespace montelux
