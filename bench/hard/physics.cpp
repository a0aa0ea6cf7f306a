// Families from physics: resonances in phase space, lattice Green's functions, Feynman parameters.
#include "bench/hard/bank.h"
#include "bench/hard/draws.h"
#include "bench/hard/quadrature.h"
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/zeta.hpp>
#include <limits>
#include <utility>

namespace montelux::bench {

namespace {

struct Resonance {
    double mass_squared, width; // of M^2, and M Gamma
    double weight;
};

HardIntegral phase_space(Draws& draws) {
    const int masses = draws.integer(1, 3), angles = draws.integer(0, 2);
    std::vector<std::vector<Resonance>> resonances;
    double exact = 1, narrowest = 1;
    for (int j = 0; j < masses; ++j) {
        std::vector<Resonance> of_mass;
        double one = 0;
        for (int k = draws.integer(1, 2); k > 0; --k) {
            Resonance r{draws.uniform(0.1, 0.9), 0, draws.uniform(0.3, 1)};
            r.width = r.mass_squared * draws.log_uniform(1e-4, 1e-2);
            narrowest = std::min(narrowest, r.width);
            one +=
                r.weight * (std::atan((1 - r.mass_squared) / r.width) + std::atan(r.mass_squared / r.width));
            of_mass.push_back(r);
        }
        exact *= one;
        resonances.push_back(std::move(of_mass));
    }
    const double slope = draws.uniform(0.2, 1);
    for (int j = 0; j < angles; ++j) exact *= 2 + 2 * slope / 3;
    std::vector<Range> ranges = box(masses, 0, 1);
    for (int j = 0; j < angles; ++j) ranges.push_back({-1, 1});
    return {.ranges = ranges,
            .f =
                [=](const double* x) {
                    double product = 1;
                    for (int j = 0; j < masses; ++j) {
                        double total = 0;
                        for (const Resonance& r : resonances[j]) {
                            const double t = (x[j] - r.mass_squared) / r.width;
                            total += r.weight / (r.width * (1 + t * t));
                        }
                        product *= total;
                    }
                    for (int j = masses; j < masses + angles; ++j) product *= 1 + slope * x[j] * x[j];
                    return product;
                },
            .exact = exact,
            .parameters = words("n = ", masses + angles, ", ", masses, " masses, narrowest ", narrowest)};
}

// exp(-t) I_0(t): the mean of exp(-t (1 - cos)) over the circle, or its asymptotic series.
double scaled_bessel(double t) {
    if (t > 40) {
        double term = 1, sum = 1;
        for (int k = 1; k < 30; ++k) {
            term *= (2 * k - 1) * (2 * k - 1) / (8 * t * k);
            sum += term;
        }
        return sum / std::sqrt(2 * pi_ * t);
    }
    constexpr int points = 64;
    double total = 0;
    for (int i = 0; i < points; ++i) total += std::exp(-t * (1 - std::cos(2 * pi_ * i / points)));
    return total / points;
}

// Mean over the circles of 1 / sum a_j (1 - cos x_j), in three variables: the integral over t > 0 of
// prod exp(-a_j t) I_0(a_j t). Its tail falls as t^-3/2 and is smooth in t^-1/2.
double watson(const std::vector<double>& a) {
    auto product = [&](double t) {
        double value = 1;
        for (double a_j : a) value *= scaled_bessel(a_j * t);
        return value;
    };
    return integrate_by_panels(0, 4, 16, product) +
           integrate_by_panels(0, 0.5, 16, [&](double v) { return 2 * product(1 / (v * v)) / (v * v * v); });
}

HardIntegral lattice(Draws& draws) {
    const bool inside = draws.chance(0.5);
    const int n = draws.chance(0.6) ? 3 : 2;
    std::vector<double> a(static_cast<std::size_t>(n), 1.0);
    double gap = 0, exact;
    if (n == 2) {
        gap = draws.log_uniform(1e-6, 1e-1);
        const double energy = 2 + gap;
        exact = 2 / (pi_ * energy) * boost::math::ellint_1(2 / energy);
    } else {
        if (draws.chance(0.6)) a = draws.uniforms(3, 0.3, 1.5);
        exact = watson(a);
    }
    const std::vector<double> shift = draws.uniforms(n, 0.2 * pi_, 1.8 * pi_);
    return {.ranges = box(n, 0, inside ? 2 * pi_ : pi_),
            .f =
                [=](const double* x) {
                    double total = gap;
                    for (int j = 0; j < n; ++j) {
                        const double half = std::sin((inside ? x[j] - shift[j] : x[j]) / 2);
                        total += 2 * a[j] * half * half;
                    }
                    return 1 / total;
                },
            .exact = exact * std::pow(inside ? 2 * pi_ : pi_, n),
            .parameters = words("n = ", n, ", gap ", gap, ", first coupling ", a[0],
                                inside ? ", pole inside" : ", pole at the corner"),
            .accuracy = 1e-10};
}

// The massless two-loop propagator ("kite") at p^2 = 1: 1 / (U F) over five Feynman parameters, of which one
// is set to 1 (Cheng, Wu): 6 zeta(3). The others are scaled, which changes no integral.
HardIntegral kite(Draws& draws) {
    const int fixed = draws.integer(0, 4);
    std::vector<double> scale;
    for (int j = 0; j < 4; ++j) scale.push_back(draws.log_uniform(0.5, 2));
    return {.ranges = box(4, 0, std::numeric_limits<double>::infinity()),
            .f =
                [=](const double* y) {
                    double x[5], jacobian = 1;
                    for (int j = 0, k = 0; j < 5; ++j) {
                        x[j] = j == fixed ? 1 : scale[k] * y[k];
                        if (j != fixed) jacobian *= scale[k++];
                    }
                    const double u = (x[0] + x[1]) * (x[2] + x[3]) + x[4] * (x[0] + x[1] + x[2] + x[3]);
                    const double f = x[0] * x[1] * (x[2] + x[3] + x[4]) + x[2] * x[3] * (x[0] + x[1] + x[4]) +
                                     x[0] * x[3] * x[4] + x[1] * x[2] * x[4];
                    return jacobian / (u * f);
                },
            .exact = 6 * boost::math::zeta(3.0),
            .parameters = words("two-loop propagator, parameter ", fixed + 1, " fixed")};
}

// 1 / (m^2 + Q^2 x y) over x, y >= 0, x + y <= 1, with y = (1 - x) v:
// ln^2((beta + 1) / (beta - 1)) / (2 Q^2), beta^2 = 1 + 4 m^2 / Q^2.
HardIntegral triangle(Draws& draws) {
    const double mass = draws.log_uniform(1e-6, 1);
    const double beta = std::sqrt(1 + 4 * mass);
    const double logarithm = 2 * std::log1p(beta) - std::log(4 * mass);
    return {.ranges = box(2, 0, 1),
            .f = [=](const double* x) { return (1 - x[0]) / (mass + x[0] * (1 - x[0]) * x[1]); },
            .exact = 0.5 * logarithm * logarithm,
            .parameters = words("one-loop triangle, m^2 / Q^2 = ", mass)};
}

// Bubbles in a row, each the integral over x in [0, 1] of 1 / (m^2 + x (1 - x)), which is
// 2 / b ln((b + 1) / (b - 1)) with b^2 = 1 + 4 m^2.
HardIntegral bubble_chain(Draws& draws) {
    const int loops = draws.integer(2, 4);
    const double mass = draws.log_uniform(1e-4, 1e-1), root = std::sqrt(1 + 4 * mass);
    const double one = 2 / root * (2 * std::log1p(root) - std::log(4 * mass));
    return {.ranges = box(loops, 0, 1),
            .f =
                [=](const double* x) {
                    double product = 1;
                    for (int j = 0; j < loops; ++j) product /= mass + x[j] * (1 - x[j]);
                    return product;
                },
            .exact = std::pow(one, loops),
            .parameters = words("chain of ", loops, " bubbles, m^2 = ", mass)};
}

HardIntegral feynman(Draws& draws) {
    const double kind = draws.uniform();
    return kind < 0.5 ? kite(draws) : kind < 0.8 ? triangle(draws) : bubble_chain(draws);
}

constexpr HardFamily families[] = {
    {"phase_space",
     "1 or 2 Breit-Wigner resonances in each of 1..3 invariant masses in [0, 1], M Gamma = M^2 times "
     "1e-4..1e-2 "
     "(log-uniform), and 1 + s x^2 in 0..2 angles. Exact: arc tangents",
     phase_space},
    {"lattice",
     "1 / sum a_j (1 - cos x_j) in 3 variables (Watson's integral for a = 1), 1 / (g + sum (1 - cos x_j)) in "
     "2, "
     "g log-uniform in 1e-6..0.1; over [0, pi]^n, or over [0, 2 pi]^n with the pole at a random point. "
     "Exact: "
     "Gauss panels over Bessel functions, elliptic integral",
     lattice},
    {"feynman",
     "the massless two-loop propagator, 6 zeta(3), over [0, infinity)^4; a one-loop triangle, m^2 / Q^2 "
     "log-uniform in 1e-6..1; chains of 2..4 bubbles 1 / (m^2 + x (1 - x)). Exact: closed forms",
     feynman},
};

} // namespace

std::span<const HardFamily> physics_families() { return families; }

} // namespace montelux::bench
