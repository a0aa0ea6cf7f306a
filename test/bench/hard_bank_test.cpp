#include "bench/hard/bank.h"
#include "bench/integrate/gauss_legendre.h"
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/philox_stream.h"

namespace montelux::bench {
namespace {

constexpr double pi = std::numbers::pi;

HardProblem problem_of(const char* family, std::uint64_t seed) {
    const HardFamily* found = hard_family_named(family);
    EXPECT_NE(found, nullptr) << family;
    return {*found, seed};
}

double relative_difference(double a, double b) { return std::abs(a - b) / std::abs(b); }

std::string name_of(const HardProblem& problem) {
    return problem.name() + " seed " + std::to_string(problem.seed()) + " (" + problem.parameters() + ")";
}

// The first seeds of a family whose integrals have that many variables and parameters that contain `text`.
std::vector<HardProblem> some_of(const char* family, std::size_t count, int least, int most,
                                 const std::string& text = "") {
    std::vector<HardProblem> found;
    for (std::uint64_t seed = 0; seed < 400 && found.size() < count; ++seed) {
        HardProblem problem = problem_of(family, seed);
        if (problem.dimensions() >= least && problem.dimensions() <= most &&
            problem.parameters().find(text) != std::string::npos)
            found.push_back(std::move(problem));
    }
    EXPECT_EQ(found.size(), count) << family << " " << text;
    return found;
}

// Gauss panels along each axis of a finite box of one or two variables.
double product_rule(const HardProblem& f, int panels) {
    const Range x = f.ranges()[0];
    double point[2];
    return integrate_by_panels(x.lower, x.upper, panels, [&](double first) {
        point[0] = first;
        if (f.dimensions() == 1) return f(point);
        const Range y = f.ranges()[1];
        return integrate_by_panels(y.lower, y.upper, panels, [&](double second) {
            point[1] = second;
            return f(point);
        });
    });
}

// Where the integrand is smooth at the scale of a panel.
TEST(HardBank, SmoothFamiliesHaveTheIntegralsOfProductRules) {
    struct Case {
        const char* family;
        int panels;
    };
    for (const Case& c : {Case{"eggbox", 40},
                          {"rosenbrock", 48},
                          {"ring", 40},
                          {"mixture", 48},
                          {"mixture_of_widths", 40},
                          {"spike", 48},
                          {"bump", 40},
                          {"ridge_diagonal", 40},
                          {"ridge_curve", 48},
                          {"cancelling", 8}})
        for (const HardProblem& f : some_of(c.family, 2, 1, 2))
            EXPECT_LT(relative_difference(product_rule(f, c.panels), f.exact()), 1e-8) << name_of(f);
    EXPECT_LT(relative_difference(product_rule(some_of("two_shells", 1, 2, 2)[0], 48),
                                  some_of("two_shells", 1, 2, 2)[0].exact()),
              1e-8);
}

// Where the integrand is a product of functions of one coordinate each: its value at a point times the
// integrals along the axes through that point, over [0, 1] or carried to it, by panels that shrink towards
// both ends.
double product_of_axes(const HardProblem& f, int panels) {
    const auto n = static_cast<std::size_t>(f.dimensions());
    const std::vector<double> through(n, 0.37);
    const double centre = f.on_unit_cube(through.data());
    double product = centre;
    for (std::size_t j = 0; j < n; ++j)
        product *= integrate_by_panels(0, 1, panels, [&](double t) {
            std::vector<double> u = through;
            u[j] = t * t * (3 - 2 * t);
            return 6 * t * (1 - t) * f.on_unit_cube(u.data()) / centre;
        });
    return product;
}

TEST(HardBank, ProductsHaveTheIntegralsOfTheirAxes) {
    for (const HardProblem& f : some_of("heavy_tails", 2, 1, 4, "product"))
        EXPECT_LT(relative_difference(product_of_axes(f, 400), f.exact()), 1e-8) << name_of(f);
    for (const HardProblem& f : some_of("heavy_tails", 2, 1, 4, "half-lines"))
        EXPECT_LT(relative_difference(product_of_axes(f, 400), f.exact()), 1e-3) << name_of(f);
    for (const HardProblem& f : some_of("phase_space", 2, 1, 5))
        EXPECT_LT(relative_difference(product_of_axes(f, 4000), f.exact()), 1e-6) << name_of(f);
    for (const char* kind : {"Sobol' g", "product", "Gaussian"})
        for (const HardProblem& f : some_of("high_dimensional", 1, 20, 200, kind))
            EXPECT_LT(relative_difference(product_of_axes(f, 4), f.exact()), 1e-10) << name_of(f);
    for (const HardProblem& f : some_of("feynman", 1, 2, 4, "bubbles"))
        EXPECT_LT(relative_difference(product_of_axes(f, 100), f.exact()), 1e-9) << name_of(f);
}

TEST(HardBank, EllipticTailsHaveTheIntegralOfAProductRule) {
    for (const HardProblem& f : some_of("heavy_tails", 2, 2, 2, "elliptic")) {
        auto towards_ends = [](double t) { return t * t * (3 - 2 * t); };
        const double integral = integrate_by_panels(0, 1, 50, [&](double s) {
            return integrate_by_panels(0, 1, 50, [&](double t) {
                const double u[2] = {towards_ends(s), towards_ends(t)};
                return 36 * s * (1 - s) * t * (1 - t) * f.on_unit_cube(u);
            });
        });
        EXPECT_LT(relative_difference(integral, f.exact()), 1e-3) << name_of(f);
    }
}

// x = t^200 makes them bounded.
TEST(HardBank, EndpointSingularitiesHaveTheirIntegrals) {
    for (const HardProblem& f : some_of("endpoint", 6, 1, 3)) {
        const auto n = static_cast<std::size_t>(f.dimensions());
        const std::vector<double> through(n, 0.5);
        double product = f(through.data());
        for (std::size_t j = 0; j < n; ++j)
            product *= integrate_by_panels(0, 1, 40, [&](double t) {
                std::vector<double> x = through;
                x[j] = std::pow(t, 200);
                return x[j] > 0 ? 200 * std::pow(t, 199) * f(x.data()) / f(through.data()) : 0;
            });
        EXPECT_LT(relative_difference(product, f.exact()), 1e-6) << name_of(f);
    }
}

// Peaks on infinite ranges, in a box of 40 widths about the only place where they are not 0.
TEST(HardBank, FarPeaksAreNormalised) {
    for (const HardProblem& f : some_of("far_peak", 3, 1, 1)) {
        const bool whole = std::isinf(f.ranges()[0].lower);
        auto value = [&](double x) { return f(&x); };
        const double integral =
            whole ? integrate_by_panels(-1200, 1200, 24000, value)
                  : integrate_by_panels(0, 0.1, 4000, value) + integrate_by_panels(0.1, 4e4, 40000, value);
        EXPECT_LT(relative_difference(integral, f.exact()), 1e-9) << name_of(f);
    }
}

// The divergence theorem: 1 / r is the divergence of the unit vector from c over n - 1, so that the integral
// over the cube is one over its faces, where the integrand is smooth.
TEST(HardBank, CoulombPotentialsAreIntegralsOverTheFaces) {
    for (int n : {2, 3})
        for (const HardProblem& f : some_of("diagonal", 3, n, n, "1 / r")) {
            // The centre from the values at two corners would do; the parameters in words have 4 digits only.
            auto inverse_square = [&](const std::vector<double>& x) { return 1 / std::pow(f(x.data()), 2); };
            const std::vector<double> origin(static_cast<std::size_t>(n), 0.0);
            std::vector<double> centre;
            for (int j = 0; j < n; ++j) {
                std::vector<double> corner = origin;
                corner[j] = 1;
                centre.push_back((inverse_square(origin) - inverse_square(corner) + 1) / 2);
            }
            double total = 0;
            for (int j = 0; j < n; ++j)
                for (double side : {0.0, 1.0}) {
                    std::vector<double> x(static_cast<std::size_t>(n), side);
                    const double height = std::abs(side - centre[j]);
                    total += height * integrate_by_panels(0, 1, 20, [&](double u) {
                                 x[(j + 1) % n] = u;
                                 if (n == 2) return f(x.data());
                                 return integrate_by_panels(0, 1, 20, [&](double v) {
                                     x[(j + 2) % n] = v;
                                     return f(x.data());
                                 });
                             });
                }
            EXPECT_LT(relative_difference(total / (n - 1), f.exact()), 1e-10) << name_of(f);
        }
}

// Along lines through the singularity, each point of the other variable splits the range where the integrand
// is infinite; t -> t^2 on both sides takes the root away.
TEST(HardBank, SingularLinesHaveTheirIntegrals) {
    for (const HardProblem& f : some_of("diagonal", 4, 2, 2, "^-1/2")) {
        // 1 / f^2 = |a x + b y - c|, from which a, b and c follow up to one sign.
        auto form = [&](double x, double y) {
            const double point[2] = {x, y};
            return 1 / std::pow(f(point), 2);
        };
        auto inner = [&](double x) {
            // The zero in y, by bisection for the smallest value along a convex function.
            double low = 0, high = 1;
            for (int i = 0; i < 200; ++i) {
                const double a = low + (high - low) / 3, b = high - (high - low) / 3;
                (form(x, a) < form(x, b) ? high : low) = form(x, a) < form(x, b) ? b : a;
            }
            const double zero = 0.5 * (low + high);
            return integrate_by_panels(0, 1, 4, [&](double t) {
                const double below[2] = {x, zero * (1 - t * t)}, above[2] = {x, zero + (1 - zero) * t * t};
                return 2 * t * ((zero > 0 ? zero * f(below) : 0) + (zero < 1 ? (1 - zero) * f(above) : 0));
            });
        };
        EXPECT_LT(relative_difference(integrate_by_panels(0, 1, 100, inner), f.exact()), 1e-4) << name_of(f);
    }
}

// With one variable in closed form, mean of 1 / (A - a cos) = 1 / sqrt(A^2 - a^2), and z = y v and the like
// (Duffy 1982) for the pole at the corner. The constant of Watson 1939.
TEST(HardBank, LatticeIntegralsByAnotherReduction) {
    int checked = 0;
    for (const HardProblem& f : some_of("lattice", 3, 3, 3, "corner")) {
        // The couplings from values on the axes: 1 / f(pi e_j) = 2 a_j.
        double a[3];
        for (int j = 0; j < 3; ++j) {
            double x[3] = {0, 0, 0};
            x[j] = pi;
            a[j] = 0.5 / f(x);
        }
        auto after_x = [&](double y, double z) {
            const double sy = std::sin(y / 2), sz = std::sin(z / 2);
            const double rest = 2 * a[1] * sy * sy + 2 * a[2] * sz * sz;
            return pi / std::sqrt(rest * (rest + 2 * a[0]));
        };
        const double integral = integrate_by_panels(0, pi, 8, [&](double y) {
            return integrate_by_panels(0, 1, 8,
                                       [&](double v) { return y * (after_x(y, y * v) + after_x(y * v, y)); });
        });
        EXPECT_LT(relative_difference(integral, f.exact()), 1e-9) << name_of(f);
        if (a[0] == 1 && a[1] == 1 && a[2] == 1) {
            ++checked;
            EXPECT_LT(relative_difference(f.exact(), 0.505462019717326 * pi * pi * pi), 1e-10);
        }
    }
    for (const HardProblem& f : some_of("lattice", 1, 3, 3, "first coupling 1,"))
        checked +=
            relative_difference(f.exact() / std::pow(f.ranges()[0].upper, 3), 0.505462019717326) < 1e-10;
    EXPECT_GE(checked, 1);
    for (const HardProblem& f : some_of("lattice", 2, 2, 2, "corner")) {
        const double origin[2] = {0, 0}, gap = 1 / f(origin);
        // Substituted so that the peak of width sqrt(gap) is wide: y = sqrt(gap) sinh s.
        const double root = std::sqrt(gap), most = std::asinh(pi / root);
        const double integral = integrate_by_panels(0, most, 40, [&](double s) {
            const double sine = std::sin(root * std::sinh(s) / 2), rest = gap + 2 * sine * sine;
            return root * std::cosh(s) * pi / std::sqrt(rest * (rest + 2));
        });
        EXPECT_LT(relative_difference(integral, f.exact()), 1e-10) << name_of(f);
    }
}

// In logarithms of the parameters the integrand is analytic and falls exponentially: the trapezoidal rule.
TEST(HardBank, TwoLoopPropagatorIsSixZetaThree) {
    const HardProblem f = some_of("feynman", 1, 4, 4, "two-loop")[0];
    constexpr int most = 15;
    constexpr double step = 0.9;
    double total = 0, x[4];
    for (int i = -most; i <= most; ++i)
        for (int j = -most; j <= most; ++j)
            for (int k = -most; k <= most; ++k)
                for (int l = -most; l <= most; ++l) {
                    x[0] = std::exp(step * i), x[1] = std::exp(step * j);
                    x[2] = std::exp(step * k), x[3] = std::exp(step * l);
                    total += f(x) * x[0] * x[1] * x[2] * x[3];
                }
    EXPECT_LT(relative_difference(total * std::pow(step, 4), f.exact()), 2e-4);
}

TEST(HardBank, TriangleByQuadrature) {
    for (const HardProblem& f : some_of("feynman", 2, 2, 2, "triangle")) {
        const double corner[2] = {0, 0}, mass = 1 / f(corner);
        // One parameter in closed form, the other towards both its ends through t / (1 - t) = exp s.
        const double integral = integrate_by_panels(-60, 60, 120, [&](double s) {
            const double t = 1 / (1 + std::exp(-s)), rest = 1 / (1 + std::exp(s));
            return rest * std::log1p(t * rest / mass);
        });
        EXPECT_LT(relative_difference(integral, f.exact()), 1e-10) << name_of(f);
    }
}

struct PlainMean {
    double mean, error, effective; // `effective`: (sum |f|)^2 / sum f^2
};
PlainMean plain_mean(const HardProblem& f, int points, std::uint64_t seed) {
    PhiloxStream numbers(hash_key(f.seed(), seed));
    const auto n = static_cast<std::size_t>(f.dimensions());
    // Relative to the exact value, so that squares of 1e-300 do not vanish.
    std::vector<double> u(n);
    double sum = 0, sizes = 0, squares = 0;
    for (int i = 0; i < points; ++i) {
        for (double& u_j : u) u_j = numbers.next_double() + 0x1p-54;
        const double value = f.on_unit_cube(u.data()) / f.exact();
        sum += value;
        sizes += std::abs(value);
        squares += value * value;
    }
    const double mean = sum / points;
    return {mean, std::sqrt(std::max(0.0, squares / points - mean * mean) / points), sizes * sizes / squares};
}

// Every family by plain Monte Carlo where random points see enough of it and the variance is finite. Seeds
// are fixed; 5.5 errors are exceeded by one right value in 10^7 where the means are normal.
TEST(HardBank, ExactValuesAgreeWithPlainMonteCarlo) {
    const std::set<std::string> others = {"endpoint", "diagonal",   "heavy_tails",    "lattice",
                                          "feynman",  "rare_event", "rare_complement"};
    std::set<std::string> tested;
    for (const HardFamily& family : hard_families()) {
        if (others.contains(std::string(family.name))) continue;
        int count = 0;
        for (std::uint64_t seed = 0; seed < 60 && count < 5; ++seed) {
            const HardProblem f(family, seed);
            const PlainMean pilot = plain_mean(f, 500, 1);
            if (!(pilot.effective > 20)) continue;
            const PlainMean mean = plain_mean(f, 20000, 2);
            EXPECT_LT(std::abs(mean.mean - 1), 5.5 * mean.error + 1e-4 * (family.name == "nearly_constant"))
                << name_of(f);
            tested.insert(std::string(family.name));
            ++count;
        }
    }
    for (const char* family :
         {"mixture", "ring", "ridge_diagonal", "ridge_curve", "jump_sphere", "jump_plane", "option",
          "high_dimensional", "scale", "nearly_constant", "cancelling", "genz", "bump", "spike"})
        EXPECT_TRUE(tested.contains(family)) << family;
}

// Regions of which random points see at least 100: the numbers of hits are Poisson's.
TEST(HardBank, RareEventsHaveTheirProbabilities) {
    for (const char* family : {"rare_event", "rare_complement"}) {
        int boxes = 0, sums = 0;
        for (std::uint64_t seed = 0; seed < 100; ++seed) {
            const HardProblem f = problem_of(family, seed);
            const bool complement = f.name() == "rare_complement";
            const double p = complement ? 1 - f.exact() : f.exact();
            if (p < 2e-3 || std::isinf(f.ranges()[0].lower)) continue;
            constexpr int points = 50000;
            const double share = plain_mean(f, points, 3).mean * f.exact();
            EXPECT_NEAR(complement ? 1 - share : share, p, 5.5 * std::sqrt(p / points)) << name_of(f);
            (f.parameters().find("box") != std::string::npos ? boxes : sums) += 1;
        }
        EXPECT_GE(boxes, 1);
        EXPECT_GE(sums, 1);
    }
}

TEST(HardBank, SeedsDrawTheSameIntegralAgainAndOthersOtherwise) {
    std::set<std::string> names;
    for (const HardFamily& family : hard_families()) {
        EXPECT_TRUE(names.insert(std::string(family.name)).second);
        EXPECT_EQ(hard_family_named(family.name), &family);
        std::set<std::string> parameters;
        for (std::uint64_t seed = 0; seed < 6; ++seed) {
            const HardProblem f(family, seed), again(family, seed);
            EXPECT_EQ(f.exact(), again.exact());
            EXPECT_EQ(f.parameters(), again.parameters());
            EXPECT_TRUE(std::isfinite(f.exact()) && f.exact() > 0) << name_of(f);
            parameters.insert(f.parameters());
            // At one point as in a batch of them.
            const std::vector<double> u(static_cast<std::size_t>(f.dimensions()), 0.4);
            const double value = f.on_unit_cube(u.data());
            EXPECT_EQ(value, again.on_unit_cube(u.data()));
        }
        EXPECT_GE(parameters.size(), family.name == "feynman" ? 3u : 5u) << family.name;
    }
    EXPECT_GE(names.size(), 20u);
    EXPECT_EQ(hard_family_named("easy"), nullptr);
}

} // namespace
} // namespace montelux::bench
