// Closed forms and one-dimensional reductions from which the bank's exact values are made.
#pragma once

#include "bench/integrate/gauss_legendre.h"
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace montelux::bench {

inline constexpr double pi_ = std::numbers::pi;

// Integral over [a, b] of exp(-(x - mean)^2 / (2 s^2)); without cancellation in either tail.
inline double gaussian_integral(double a, double b, double mean, double s) {
    const double from = (a - mean) / (s * std::numbers::sqrt2), to = (b - mean) / (s * std::numbers::sqrt2);
    double share;
    if (from > 0)
        share = std::erfc(from) - std::erfc(to);
    else if (to < 0)
        share = std::erfc(-to) - std::erfc(-from);
    else
        share = std::erf(to) - std::erf(from);
    return s * std::sqrt(pi_ / 2) * share;
}

// Integral over all of space in n dimensions of g(|x|), which vanishes outside [a, b].
template <typename G>
double radial_integral(int n, double a, double b, int panels, const G& g) {
    const double area = 2 * std::exp(0.5 * n * std::log(pi_) - std::lgamma(0.5 * n));
    return area * integrate_by_panels(a, b, panels, [&](double r) { return std::pow(r, n - 1) * g(r); });
}

inline double distance_squared(const double* x, const std::vector<double>& centre) {
    double total = 0;
    for (std::size_t j = 0; j < centre.size(); ++j) total += (x[j] - centre[j]) * (x[j] - centre[j]);
    return total;
}

} // namespace montelux::bench
