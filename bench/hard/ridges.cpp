// Families of ridges that no axis follows.
#include "bench/hard/bank.h"
#include "bench/hard/draws.h"
#include "bench/hard/quadrature.h"

namespace montelux::bench {

namespace {

// The Gaussian of width w, its centre carried along the segment from c - l d to c + l d, d_j = +-1:
// |x - c - t d|^2 = n (t - m)^2 + |x - c|^2 - n m^2 with m = d.(x - c) / n, so that the integral over t is
// closed.
HardIntegral ridge_on_diagonal(Draws& draws) {
    const int n = draws.integer(2, 6);
    const double w = draws.log_uniform(0.01, 0.05), length = draws.uniform(0.2, 0.4);
    const std::vector<double> centre = draws.uniforms(n, 0.45, 0.55);
    std::vector<double> sign;
    for (int j = 0; j < n; ++j) sign.push_back(draws.chance(0.5) ? 1 : -1);
    auto f = [=](const double* x) {
        double along = 0;
        for (int j = 0; j < n; ++j) along += sign[j] * (x[j] - centre[j]) / n;
        const double across = std::max(0.0, distance_squared(x, centre) - n * along * along);
        return std::exp(-across / (2 * w * w)) *
               gaussian_integral(-length, length, along, w / std::sqrt(static_cast<double>(n)));
    };
    const double exact = integrate_by_panels(-length, length, 64, [&](double t) {
        double product = 1;
        for (int j = 0; j < n; ++j) product *= gaussian_integral(0, 1, centre[j] + t * sign[j], w);
        return product;
    });
    return {.ranges = box(n, 0, 1),
            .f = f,
            .exact = exact,
            .parameters = words("n = ", n, ", width ", w, ", half length ", length, " along each axis")};
}

// y = g(x), or (y, z) = (g(x), h(x)).
struct Curve {
    bool wave;
    double frequency, phase, height;

    double operator()(double x) const {
        if (wave) return 0.5 + height * std::sin(2 * pi_ * frequency * x + phase);
        return 0.5 + height * (8 * (x - 0.5) * (x - 0.5) - 1);
    }
};

HardIntegral ridge_on_curve(Draws& draws) {
    const int n = draws.integer(2, 3);
    const double w = draws.log_uniform(0.005, 0.05);
    std::vector<Curve> curves;
    for (int j = 1; j < n; ++j)
        curves.push_back({draws.chance(0.7), draws.uniform(0.7, 2.5), draws.uniform(0, 2 * pi_),
                          draws.uniform(0.2, 0.35)});
    const double frequency = draws.uniform(0.5, 3), slope = draws.uniform(-1, 1);
    auto along = [=](double x) {
        return std::exp(slope * x) * (1 + 0.5 * std::cos(2 * pi_ * frequency * x));
    };
    auto f = [=](const double* x) {
        double square = 0;
        for (std::size_t k = 0; k < curves.size(); ++k) {
            const double t = (x[k + 1] - curves[k](x[0])) / w;
            square += t * t;
        }
        return along(x[0]) * std::exp(-0.5 * square);
    };
    const double exact = integrate_by_panels(0, 1, 64, [&](double x) {
        double product = along(x);
        for (const Curve& curve : curves) product *= gaussian_integral(0, 1, curve(x), w);
        return product;
    });
    return {.ranges = box(n, 0, 1),
            .f = f,
            .exact = exact,
            .parameters = words("n = ", n, ", width ", w, curves[0].wave ? ", wave" : ", parabola")};
}

constexpr HardFamily families[] = {
    {"ridge_diagonal",
     "the Gaussian of width w, its centre carried along a segment of a random diagonal, over the unit cube; "
     "n "
     "in 2..6, w log-uniform in 0.01..0.05. Exact: Gauss panels over products of error functions",
     ridge_on_diagonal},
    {"ridge_curve",
     "exp(s x) (1 + cos(k x) / 2) exp(-|y - g(x)|^2 / (2 w^2)) over the unit cube, g waves or parabolas; n "
     "in "
     "2, 3; w log-uniform in 0.005..0.05. Exact: Gauss panels over error functions",
     ridge_on_curve},
};

} // namespace

std::span<const HardFamily> ridge_families() { return families; }

} // namespace montelux::bench
