// One-loop integrals of four dimensions in Feynman parameters, all lines of mass m, at Euclidean momenta
// (Q^2 > 0): over the simplex x_j >= 0, sum of x <= 1, no thresholds. Factors of i pi^2 left out.
#include "comparison.h"
#include <cmath>
#include <montelux/mc/integrate/adaptive/adaptive.h>
#include <montelux/mc/integrate/cubature/cubature.h>
#include <montelux/mc/integrate/integrate.h>

using namespace montelux;

constexpr double mass_squared = 0.02;

// Two massless legs and one of Q^2: C0 = ln^2((beta + 1) / (beta - 1)) / (2 Q^2), beta^2 = 1 + 4 m^2 / Q^2
// (the loop of H -> gamma gamma below threshold, continued).
double exact_triangle(double q2) {
    const double beta = std::sqrt(1 + 4 * mass_squared / q2);
    const double logarithm = std::log((beta + 1) / (beta - 1));
    return logarithm * logarithm / (2 * q2);
}

int main() {
    Comparison comparison;

    const double q2 = 1;
    const auto triangle =
        integrate([=](std::span<const double> x) { return 1 / (mass_squared + q2 * x[0] * x[1]); },
                  Domain::simplex(2), Method(), {.relative_error = 1e-6});
    std::cout << "triangle: " << triangle << "\n\n";
    comparison.add("C0(0, 0, -Q^2; m^2)", triangle.estimate(), exact_triangle(q2));

    // Massless legs, s and t of opposite sign to the physical ones:
    // D0 = integral of 1 / (m^2 + s x1 x3 + t x2 x4)^2, x4 = 1 - x1 - x2 - x3. Gamma(2) = 1.
    const double s = 1, t = 0.5;
    const auto box = [=](std::span<const double> x) {
        const double x4 = 1 - x[0] - x[1] - x[2];
        const double f = mass_squared + s * x[0] * x[2] + t * x[1] * x4;
        return 1 / (f * f);
    };
    const auto sampled = integrate(box, Domain::simplex(3), Adaptive{}, {.relative_error = 1e-4});
    const auto by_rules = integrate(box, Domain::simplex(3), Cubature{}, {.relative_error = 1e-6});
    std::cout << "\nbox: " << sampled << "\n\n";
    comparison.add("D0(0, 0, 0, 0, -s, -t; m^2)", sampled.estimate(), by_rules.value[0],
                   by_rules.standard_error[0]);
    return comparison.exit_code();
}
