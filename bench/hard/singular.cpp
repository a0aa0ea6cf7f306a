// Families with integrable singularities, at the ends of ranges and inside.
#include "bench/hard/bank.h"
#include "bench/hard/draws.h"
#include "bench/hard/quadrature.h"

namespace montelux::bench {

namespace {

HardIntegral endpoint(Draws& draws) {
    const int n = draws.integer(1, 3);
    std::vector<double> a;
    double exact = 1;
    const bool roots = n > 1 && draws.chance(0.3);
    for (int j = 0; j < n; ++j) {
        a.push_back(roots ? 0.5 : draws.uniform(0.5, n == 1 ? 0.99 : 0.9));
        exact *= 1 / (1 - a[j]) + 1 / (2 - a[j]);
    }
    return {.ranges = box(n, 0, 1),
            .f =
                [=](const double* x) {
                    double product = 1;
                    for (int j = 0; j < n; ++j) product *= std::pow(x[j], -a[j]) * (1 + x[j]);
                    return product;
                },
            .exact = exact,
            .parameters = words("n = ", n, ", powers ", a[0], n > 1 ? words(", ", a[1]) : "",
                                n > 2 ? words(", ", a[2]) : "")};
}

// |a x + b y - c|^-1/2 has the second antiderivative 4/3 |s|^3/2 in s.
HardIntegral on_line(Draws& draws) {
    double a = 1, b = -1, c = 0;
    if (draws.chance(0.7)) {
        a = draws.uniform(0.3, 1.5);
        b = (draws.chance(0.5) ? 1 : -1) * draws.uniform(0.3, 1.5);
        const double u = draws.uniform(0.2, 0.8), v = draws.uniform(0.2, 0.8);
        c = a * u + b * v; // through the point (u, v)
    }
    auto twice = [](double s) { return 4.0 / 3 * std::pow(std::abs(s), 1.5); };
    return {.ranges = box(2, 0, 1),
            .f = [=](const double* x) { return 1 / std::sqrt(std::abs(a * x[0] + b * x[1] - c)); },
            .exact = (twice(a + b - c) - twice(a - c) - twice(b - c) + twice(-c)) / (a * b),
            .parameters = words("|", a, " x + ", b, " y - ", c, "|^-1/2")};
}

// Integral of 1 / r over [0, a] x [0, b], and over [0, a] x [0, b] x [0, c].
double potential(double a, double b) { return a * std::asinh(b / a) + b * std::asinh(a / b); }
double potential(double a, double b, double c) {
    const double d = std::sqrt(a * a + b * b + c * c);
    return a * b * std::asinh(c / std::hypot(a, b)) + b * c * std::asinh(a / std::hypot(b, c)) +
           c * a * std::asinh(b / std::hypot(c, a)) - a * a / 2 * std::atan(b * c / (a * d)) -
           b * b / 2 * std::atan(c * a / (b * d)) - c * c / 2 * std::atan(a * b / (c * d));
}

HardIntegral coulomb(Draws& draws) {
    const int n = draws.integer(2, 3);
    std::vector<double> centre(static_cast<std::size_t>(n), 0.5);
    if (draws.chance(0.6)) centre = draws.uniforms(n, 0.1, 0.9);
    double exact = 0;
    for (double x : {centre[0], 1 - centre[0]})
        for (double y : {centre[1], 1 - centre[1]}) {
            if (n == 2)
                exact += potential(x, y);
            else
                for (double z : {centre[2], 1 - centre[2]}) exact += potential(x, y, z);
        }
    return {.ranges = box(n, 0, 1),
            .f = [=](const double* x) { return 1 / std::sqrt(distance_squared(x, centre)); },
            .exact = exact,
            .parameters =
                words("1 / r about ", centre[0], ", ", centre[1], n == 3 ? words(", ", centre[2]) : "")};
}

HardIntegral logarithm(Draws& draws) {
    const double u = draws.uniform(0.2, 0.8);
    // Antiderivative of log |x - u|.
    auto once = [](double s) { return s == 0 ? 0 : s * std::log(std::abs(s)) - s; };
    const double inner = once(1 - u) - once(-u);
    const int n = draws.integer(1, 3);
    return {.ranges = box(n, 0, 1),
            .f =
                [=](const double* x) {
                    double product = -std::log(std::abs(x[0] - u));
                    for (int j = 1; j < n; ++j) product *= 2 * x[j];
                    return product;
                },
            .exact = -inner,
            .parameters = words("n = ", n, ", -log|x - ", u, "|")};
}

HardIntegral diagonal(Draws& draws) {
    const double kind = draws.uniform();
    return kind < 0.45 ? on_line(draws) : kind < 0.9 ? coulomb(draws) : logarithm(draws);
}

constexpr HardFamily families[] = {
    {"endpoint",
     "prod x_j^-a_j (1 + x_j) over the unit cube; n in 1..3; a in 0.5..0.99 (n = 1), 0.5..0.9, or all 1/2. "
     "Exact: 1 / (1 - a) + 1 / (2 - a)",
     endpoint},
    {"diagonal",
     "|a x + b y - c|^-1/2, among them |x - y|^-1/2; 1 / |x - c| in 2 and 3 variables, c in the middle or "
     "anywhere; -log |x - u| prod 2 y; over the unit cube. Exact: closed forms, the potential of a cube",
     diagonal},
};

} // namespace

std::span<const HardFamily> singular_families() { return families; }

} // namespace montelux::bench
