// Families over infinite ranges: heavy tails and peaks far from where a map looks first.
#include "bench/hard/bank.h"
#include "bench/hard/draws.h"
#include "bench/hard/quadrature.h"
#include <limits>

namespace montelux::bench {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

HardIntegral heavy_tails(Draws& draws) {
    const int n = draws.integer(1, 4), kind = draws.integer(0, 2);
    const double freedom = draws.integer(1, 5);
    if (kind == 0) { // (1 + x)^-(1 + a) on each half-line
        const std::vector<double> a = draws.uniforms(n, 0.5, 2);
        const double scale = draws.log_uniform(0.1, 10);
        double exact = 1;
        for (double power : a) exact *= scale / power;
        return {.ranges = box(n, 0, infinity),
                .f =
                    [=](const double* x) {
                        double product = 1;
                        for (int j = 0; j < n; ++j) product *= std::pow(1 + x[j] / scale, -1 - a[j]);
                        return product;
                    },
                .exact = exact,
                .parameters = words("n = ", n, ", half-lines, scale ", scale, ", first power ", 1 + a[0])};
    }
    const std::vector<double> centre = draws.uniforms(n, -5, 5);
    const double scale = draws.log_uniform(0.1, 10);
    if (kind == 1) { // product of Student's densities without their constants
        const double one = std::sqrt(freedom * pi_) *
                           std::exp(std::lgamma(freedom / 2) - std::lgamma((freedom + 1) / 2)) * scale;
        return {.ranges = box(n, -infinity, infinity),
                .f =
                    [=](const double* x) {
                        double product = 1;
                        for (int j = 0; j < n; ++j) {
                            const double t = (x[j] - centre[j]) / scale;
                            product *= std::pow(1 + t * t / freedom, -(freedom + 1) / 2);
                        }
                        return product;
                    },
                .exact = std::pow(one, n),
                .parameters = words("n = ", n, ", product, freedom ", freedom, ", scale ", scale)};
    }
    // Student's density of several variables.
    const double exact = std::pow(freedom * pi_ * scale * scale, 0.5 * n) *
                         std::exp(std::lgamma(freedom / 2) - std::lgamma((freedom + n) / 2));
    return {.ranges = box(n, -infinity, infinity),
            .f =
                [=](const double* x) {
                    const double t = distance_squared(x, centre) / (scale * scale);
                    return std::pow(1 + t / freedom, -(freedom + n) / 2);
                },
            .exact = exact,
            .parameters = words("n = ", n, ", elliptic, freedom ", freedom, ", scale ", scale)};
}

HardIntegral far_peak(Draws& draws) {
    const int n = draws.integer(1, 3);
    if (draws.chance(0.3)) {
        std::vector<double> scale;
        for (int j = 0; j < n; ++j) scale.push_back(draws.log_uniform(1e-3, 1e3));
        return {.ranges = box(n, 0, infinity),
                .f =
                    [=](const double* x) {
                        double exponent = 0, factor = 1;
                        for (int j = 0; j < n; ++j) {
                            exponent += x[j] / scale[j];
                            factor *= scale[j];
                        }
                        return std::exp(-exponent) / factor;
                    },
                .exact = 1,
                .parameters = words("n = ", n, ", exponentials, first scale ", scale[0])};
    }
    std::vector<double> mean, s;
    double factor = 1;
    const bool even = draws.chance(0.5);
    for (int j = 0; j < n; ++j) {
        mean.push_back((draws.chance(0.5) ? 1 : -1) *
                       (even ? draws.uniform(0, 1000) : draws.log_uniform(1, 1000)));
        s.push_back(draws.log_uniform(0.1, 10));
        factor /= s[j] * std::sqrt(2 * pi_);
    }
    return {.ranges = box(n, -infinity, infinity),
            .f =
                [=](const double* x) {
                    double exponent = 0;
                    for (int j = 0; j < n; ++j) {
                        const double t = (x[j] - mean[j]) / s[j];
                        exponent += t * t;
                    }
                    return factor * std::exp(-0.5 * exponent);
                },
            .exact = 1,
            .parameters =
                words("n = ", n, ", normal densities, first mean ", mean[0], ", first width ", s[0])};
}

constexpr HardFamily families[] = {
    {"heavy_tails",
     "products of (1 + x / s)^-(1 + a), a in 0.5..2, over half-lines; of Student's densities of 1..5 degrees "
     "of freedom, centres in +-5, or that density of n variables, over lines; n in 1..4, s log-uniform in "
     "0.1..10. Exact: gamma functions",
     heavy_tails},
    {"far_peak",
     "normal densities over lines, means to +-1000 (uniform, or log-uniform from 1), widths log-uniform in "
     "0.1..10; or exponential densities over half-lines, scales log-uniform in 1e-3..1e3; n in 1..3. Exact: "
     "1",
     far_peak},
};

} // namespace

std::span<const HardFamily> infinite_families() { return families; }

} // namespace montelux::bench
