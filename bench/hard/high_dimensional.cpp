// Families of many variables, to 200.
#include "bench/hard/bank.h"
#include "bench/hard/draws.h"
#include "bench/hard/quadrature.h"

namespace montelux::bench {

namespace {

// Saltelli, Sobol' 1995: prod (|4 x_j - 2| + a_j) / (1 + a_j), a_j growing as j^2.
HardIntegral sobol_g(Draws& draws) {
    const int n = draws.integer(20, 200);
    const double growth = draws.log_uniform(0.03, 1);
    return {.ranges = box(n, 0, 1),
            .f =
                [=](const double* x) {
                    double product = 1;
                    for (int j = 0; j < n; ++j) {
                        const double a = growth * j * j;
                        product *= (std::abs(4 * x[j] - 2) + a) / (1 + a);
                    }
                    return product;
                },
            .exact = 1,
            .parameters = words("Sobol' g, n = ", n, ", a_j = ", growth, " j^2")};
}

HardIntegral weak_product(Draws& draws) {
    const int n = draws.integer(20, 200);
    const double power = draws.uniform(1, 2);
    const std::vector<double> c = draws.uniforms(n, -2, 2);
    return {.ranges = box(n, 0, 1),
            .f =
                [=](const double* x) {
                    double product = 1;
                    for (int j = 0; j < n; ++j) product *= 1 + c[j] * (x[j] - 0.5) / std::pow(j + 1, power);
                    return product;
                },
            .exact = 1,
            .parameters = words("product, n = ", n, ", falling as j^-", power)};
}

HardIntegral wide_gaussian(Draws& draws) {
    const int n = draws.integer(20, 50);
    const std::vector<double> centre = draws.uniforms(n, 0, 1), width = draws.uniforms(n, 0.3, 1);
    double exact = 1;
    for (int j = 0; j < n; ++j) exact *= gaussian_integral(0, 1, centre[j], width[j]);
    return {.ranges = box(n, 0, 1),
            .f =
                [=](const double* x) {
                    double exponent = 0;
                    for (int j = 0; j < n; ++j) {
                        const double t = (x[j] - centre[j]) / width[j];
                        exponent += t * t;
                    }
                    return std::exp(-0.5 * exponent);
                },
            .exact = exact,
            .parameters = words("Gaussian, n = ", n)};
}

// cos(p + sum c_j x_j), the phase such that the mean is the product of the sincs times cos(angle), angle
// within +-pi/4.
HardIntegral cosine_of_sum(Draws& draws) {
    const int n = draws.integer(50, 200);
    std::vector<double> c = draws.uniforms(n, 0, 1);
    const double norm = draws.uniform(1, 4), angle = draws.uniform(-pi_ / 4, pi_ / 4);
    double square = 0;
    for (double c_j : c) square += c_j * c_j;
    double phase = angle, exact = std::cos(angle);
    for (double& c_j : c) {
        c_j *= norm / std::sqrt(square);
        phase -= c_j / 2;
        exact *= std::sin(c_j / 2) / (c_j / 2);
    }
    return {.ranges = box(n, 0, 1),
            .f =
                [=](const double* x) {
                    double sum = phase;
                    for (int j = 0; j < n; ++j) sum += c[j] * x[j];
                    return std::cos(sum);
                },
            .exact = exact,
            .parameters = words("cosine of a sum, n = ", n, ", norm ", norm)};
}

HardIntegral high_dimensional(Draws& draws) {
    switch (draws.integer(0, 3)) {
    case 0:
        return sobol_g(draws);
    case 1:
        return weak_product(draws);
    case 2:
        return wide_gaussian(draws);
    default:
        return cosine_of_sum(draws);
    }
}

constexpr HardFamily families[] = {
    {"high_dimensional",
     "Sobol's g-function, a_j = g j^2, and prod 1 + c_j (x_j - 1/2) j^-p, n in 20..200; Gaussians of widths "
     "0.3..1, n in 20..50; cos(p + c.x), |c| in 1..4, n in 50..200; over the unit cube. Exact: products",
     high_dimensional},
};

} // namespace

std::span<const HardFamily> high_dimensional_families() { return families; }

} // namespace montelux::bench
