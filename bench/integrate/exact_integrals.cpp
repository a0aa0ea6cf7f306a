#include "bench/integrate/gauss_legendre.h"
#include "bench/integrate/integrands.h"
#include <algorithm>
#include <cmath>
#include <numbers>

namespace montelux::bench {

namespace {

// integral over t in [0, 1] of exp(-k (t - p)^2)
double gaussian_over_unit(double k, double p) {
    const double root = std::sqrt(k);
    return std::sqrt(std::numbers::pi / k) / 2 * (std::erf(root * (1 - p)) + std::erf(root * p));
}

// (1 + s)^-(d + 1) = 1/d! integral of t^d exp(-t (1 + s)) over t > 0 makes the corner peak a product under
// one integral, all of it positive: unlike the sum over the corners of the cube, it loses no digits when a
// c_j is small.
double corner_peak_integral(std::span<const double> c) {
    const auto d = static_cast<double>(c.size());
    const double log_factorial = std::lgamma(d + 1);
    return integrate_by_panels(0, 100, 64, [&](double t) {
        double product = std::exp(d * std::log(t) - t - log_factorial);
        for (double c_j : c) product *= -std::expm1(-c_j * t) / (c_j * t);
        return product;
    });
}

} // namespace

double exact_integral(const BenchIntegrand& f) {
    const std::span<const double> c = f.c(), w = f.w();
    const std::size_t d = c.size();
    const double k = f.narrowness();
    double product = 1;
    switch (f.line().family) {
    case Family::oscillatory: {
        double total = 0;
        for (double c_j : c) {
            product *= std::sin(c_j / 2) / (c_j / 2);
            total += c_j;
        }
        return product * std::cos(f.phase() + total / 2);
    }
    case Family::product_peak:
        for (std::size_t j = 0; j < d; ++j)
            product *= c[j] * (std::atan(c[j] * (1 - w[j])) + std::atan(c[j] * w[j]));
        return product;
    case Family::corner_peak:
        return corner_peak_integral(c);
    case Family::gaussian:
        for (std::size_t j = 0; j < d; ++j) product *= gaussian_over_unit(c[j] * c[j], w[j]);
        return product;
    case Family::continuous:
        for (std::size_t j = 0; j < d; ++j)
            product *= -(std::expm1(-c[j] * w[j]) + std::expm1(-c[j] * (1 - w[j]))) / c[j];
        return product;
    case Family::discontinuous:
        for (std::size_t j = 0; j < d; ++j) product *= std::expm1(c[j] * (j < 2 ? w[j] : 1)) / c[j];
        return product;
    case Family::sine:
    case Family::exponential:
    case Family::quadratic:
    case Family::inverse_root:
        return 1;
    case Family::jump:
        return std::expm1(w[0]);
    case Family::two_peaks:
    case Family::three_peaks:
    case Family::four_peaks: {
        double mean = 0;
        for (int peak = 0; peak < f.peaks(); ++peak) {
            product = 1;
            for (double p : f.peak(peak))
                product *= gaussian_over_unit(k, p) / std::sqrt(std::numbers::pi / k);
            mean += product / f.peaks();
        }
        return mean;
    }
    case Family::ridge:
        return integrate_by_panels(f.ridge_begin(), f.ridge_end(), 8,
                                   [&](double t) {
                                       const double side =
                                           gaussian_over_unit(k, t) / std::sqrt(std::numbers::pi / k);
                                       return std::pow(side, f.dimensions());
                                   }) /
               (f.ridge_end() - f.ridge_begin());
    case Family::sum:
        return 0.5 * static_cast<double>(d);
    }
    return 0;
}

} // namespace montelux::bench
