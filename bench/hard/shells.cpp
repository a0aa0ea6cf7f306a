// Families of thin curved peaks: rings, pairs of shells, Rosenbrock's valley.
#include "bench/hard/bank.h"
#include "bench/hard/draws.h"
#include "bench/hard/quadrature.h"

namespace montelux::bench {

namespace {

double shell_integral(int n, double radius, double w) {
    return radial_integral(n, std::max(0.0, radius - 8 * w), radius + 8 * w, 16,
                           [&](double r) { return std::exp(-(r - radius) * (r - radius) / (2 * w * w)); });
}

double shell_value(double square, double radius, double w) {
    const double t = (std::sqrt(square) - radius) / w;
    return std::exp(-0.5 * t * t);
}

HardIntegral ring(Draws& draws) {
    const int n = draws.integer(2, 10);
    const double w = n == 2   ? draws.log_uniform(0.005, 0.05)
                     : n == 3 ? draws.log_uniform(0.01, 0.05)
                     : n <= 5 ? draws.log_uniform(0.02, 0.08)
                              : draws.log_uniform(0.04, 0.1);
    const double radius = draws.uniform(0.5, 1) * (0.95 - 7 * w);
    const std::vector<double> centre = draws.uniforms(n, -0.05, 0.05);
    return {.ranges = box(n, -1, 1),
            .f = [=](const double* x) { return shell_value(distance_squared(x, centre), radius, w); },
            .exact = shell_integral(n, radius, w),
            .parameters = words("n = ", n, ", radius ", radius, ", width ", w),
            .accuracy = 1e-11};
}

HardIntegral two_shells(Draws& draws) {
    constexpr int sizes[] = {2, 5, 10};
    const int n = sizes[draws.integer(0, 2)];
    double exact = 0;
    std::vector<double> centres[2], radius, width;
    for (int k = 0; k < 2; ++k) {
        centres[k].assign(static_cast<std::size_t>(n), 0.0);
        centres[k][0] = (k == 0 ? -1 : 1) * draws.uniform(3.2, 3.7);
        radius.push_back(draws.uniform(1.8, 2.2));
        width.push_back(draws.uniform(0.08, 0.12));
        exact += shell_integral(n, radius[k], width[k]) / (width[k] * std::sqrt(2 * pi_));
    }
    return {.ranges = box(n, -7, 7),
            .f =
                [=](const double* x) {
                    double total = 0;
                    for (int k = 0; k < 2; ++k)
                        total += shell_value(distance_squared(x, centres[k]), radius[k], width[k]) /
                                 (width[k] * std::sqrt(2 * pi_));
                    return total;
                },
            .exact = exact,
            .parameters = words("n = ", n, ", radii ", radius[0], ", ", radius[1], ", widths ", width[0],
                                ", ", width[1]),
            .accuracy = 1e-10};
}

// Integrates the last variable in closed form, then one after another by Gauss panels: each is coupled to its
// neighbours only.
double rosenbrock_integral(int n, double lower, double upper, double a, double b) {
    std::vector<double> nodes, weights, rest;
    constexpr int panels = 100;
    const auto& rule = GaussLegendre<20>::rule();
    integrate_by_panels(lower, upper, panels, [&](double x) {
        nodes.push_back(x);
        weights.push_back((upper - lower) / panels / 2 * rule.weights[(nodes.size() - 1) % 20]);
        return 0;
    });
    const std::size_t m = nodes.size();
    for (double x : nodes) rest.push_back(gaussian_integral(lower, upper, x * x, 1 / std::sqrt(2 * b)));
    for (std::size_t i = 0; i < m; ++i) rest[i] *= std::exp(-(a - nodes[i]) * (a - nodes[i]));
    for (int j = n - 2; j > 0; --j) {
        std::vector<double> next(m, 0.0);
        for (std::size_t i = 0; i < m; ++i) {
            const double centre = nodes[i] * nodes[i];
            for (std::size_t k = 0; k < m; ++k) {
                const double t = b * (nodes[k] - centre) * (nodes[k] - centre);
                if (t < 45) next[i] += weights[k] * std::exp(-t) * rest[k];
            }
            next[i] *= std::exp(-(a - nodes[i]) * (a - nodes[i]));
        }
        rest = std::move(next);
    }
    double total = 0;
    for (std::size_t i = 0; i < m; ++i) total += weights[i] * rest[i];
    return total;
}

HardIntegral rosenbrock(Draws& draws) {
    const int n = draws.integer(2, 6);
    const double a = draws.uniform(0.8, 1.2), b = draws.log_uniform(50, 150);
    const double lower = -draws.uniform(4.5, 5.5), upper = draws.uniform(4.5, 5.5);
    return {.ranges = box(n, lower, upper),
            .f =
                [=](const double* x) {
                    double exponent = 0;
                    for (int j = 0; j + 1 < n; ++j) {
                        const double t = x[j + 1] - x[j] * x[j];
                        exponent += (a - x[j]) * (a - x[j]) + b * t * t;
                    }
                    return std::exp(-exponent);
                },
            .exact = rosenbrock_integral(n, lower, upper, a, b),
            .parameters = words("n = ", n, ", a ", a, ", b ", b, ", over ", lower, ":", upper),
            .accuracy = 1e-10};
}

constexpr HardFamily families[] = {
    {"rosenbrock",
     "exp(-sum (a - x_j)^2 + b (x_j+1 - x_j^2)^2) over a box of about [-5, 5]^n; n in 2..6, a in 0.8..1.2, b "
     "in 50..150. Exact: transfer matrix on Gauss panels",
     rosenbrock},
    {"ring",
     "exp(-(|x - c| - r)^2 / (2 w^2)) over [-1, 1]^n; n in 2..10; w log-uniform in 0.005..0.05 (n = 2), "
     "0.01..0.05 (3), 0.02..0.08 (4, 5), 0.04..0.1; r such that the shell fits. Exact: radial Gauss panels",
     ring},
    {"two_shells",
     "two normalised Gaussian shells of radius about 2 and width about 0.1, centres at about +-3.5 on the "
     "first axis, over [-7, 7]^n; n in 2, 5, 10 (Feroz, Hobson 2008). Exact: radial Gauss panels",
     two_shells},
};

} // namespace

std::span<const HardFamily> shell_families() { return families; }

} // namespace montelux::bench
