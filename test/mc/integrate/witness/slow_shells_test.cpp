#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <string>
#include <vector>

#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/integrate/witness/first_look.h"
#include "montelux/mc/integrate/witness/slow_shells.h"

namespace montelux {
namespace {

// Shells of r^-power around a corner of n variables.
SlowShells power_law(double power, int n) {
    SlowShells slow{std::vector<double>(static_cast<std::size_t>(n), 0.0), {}, {}};
    for (double k : {3.0, 8.0, 15.0, 24.0, 36.0, 50.0}) {
        slow.exponents.push_back(k);
        slow.shells.push_back({std::vector<double>(static_cast<std::size_t>(n), std::exp2(-k)),
                               {std::exp2(power * k)},
                               std::exp2(-n * k)});
    }
    return slow;
}

TEST(SlowShells, FallSlowlyWhereTheVarianceIsInfinite) {
    for (int n : {1, 2, 3})
        for (double power : {0.3, 0.48, 0.5, 0.9}) {
            const double fall = n * (1 - power);
            EXPECT_EQ(fall_slowly(1, std::exp2(-fall * 10), 10, n), power >= 0.5) << n << " " << power;
        }
    EXPECT_FALSE(fall_slowly(1, 0, 10, 1));
    EXPECT_FALSE(fall_slowly(std::nan(""), 1, 10, 1));
}

// The integral of u^-power below 1 / N is N^(power - 1) / (1 - power).
TEST(SlowShells, MassThatPointsDoNotReach) {
    const std::vector<double> ones(6, 1.0);
    for (double power : {0.6, 0.8, 0.95})
        for (double points : {1e2, 1e4, 1e9}) {
            const double expected = std::pow(points, power - 1) / (1 - power);
            EXPECT_NEAR(unreached(power_law(power, 1), 0, ones, points), expected, 1e-3 * expected)
                << power << " " << points;
        }
    // In n variables shells are those of cubes, of mass r^(n - power) n / (n - power).
    const double expected = std::pow(1e-4, 0.3 / 3) * 3 / 0.3;
    EXPECT_NEAR(unreached(power_law(2.7, 3), 0, ones, 1e4), expected, 1e-3 * expected);
    // A density that follows the values reaches all of it.
    std::vector<double> q;
    for (double k : power_law(0.8, 1).exponents) q.push_back(0.2 * std::exp2(0.8 * k));
    EXPECT_LT(unreached(power_law(0.8, 1), 0, q, 1e9), 2e-8);
    EXPECT_GT(unreached(power_law(0.8, 1), 0, q, 1e2), 2e-3);
}

// A density that is high at one distance alone, as a Gaussian near the corner is, hides nothing before or behind it.
TEST(SlowShells, MassBeforeAndBehindADensePlace) {
    const SlowShells shells = power_law(0.9, 1);
    std::vector<double> q(6, 1e-12);
    const double nothing = unreached(shells, 0, q, 1);
    q[2] = 1e12;
    // One point or more is expected from 2^-12.61 to 2^-17.52, by the logarithms of q between the shells.
    const double reached = std::exp2(-1.261) - std::exp2(-1.752);
    EXPECT_NEAR(unreached(shells, 0, q, 1) / nothing, 1 - reached, 0.005);
}

TEST(SlowShells, OneSlowCornerCallsForTheOthers) {
    const auto f = [](std::span<const double> x) {
        return std::pow(1 + x[0] * x[0] + x[1] * x[1] + x[2] * x[2], -1.6);
    };
    for (std::uint64_t seed : {1, 2, 3}) {
        const FirstLook look =
            first_look(Evaluator(f, Domain(std::vector<Range>(3, {-infinity, infinity}))), {.seed = seed});
        EXPECT_EQ(std::ranges::count(look.slow, 3, &SlowShells::codimension), 8);
    }
}

// Errors cover what lies closer to a corner or a face than the points: exact values by iterated integration.
TEST(SlowShells, ErrorsCoverWhatPointsDoNotReach) {
    struct Case {
        const char* name;
        int dimensions;
        double (*f)(std::span<const double>);
        double exact;
    };
    const Case cases[] = {
        {"corner", 3, [](std::span<const double> x) { return std::pow(3 - x[0] - x[1] - x[2], -2.7); },
         1.95225750779},
        {"logarithm", 1,
         [](std::span<const double> x) { return 2 / (x[0] * std::pow(1 - std::log(x[0]), 3)); }, 1},
        {"face", 2, [](std::span<const double> x) { return 0.1 * std::pow(x[0], -0.9) * (0.5 + x[1]); }, 1},
        {"upper face", 2,
         [](std::span<const double> x) { return 0.1 * std::pow(1 - x[0], -0.9) * (0.5 + x[1]); }, 1}};
    for (const Case& f : cases)
        for (const char* name : {"basic", "quasi", "vegas", "adaptive"})
            for (std::uint64_t seed = 1; seed <= 8; ++seed) {
                const IntegrationResult r =
                    integrate(f.f, Domain::unit_cube(f.dimensions), Method::named(name),
                              {.relative_error = 1e-3, .evaluations = 40'000}, {.seed = seed, .threads = 1});
                EXPECT_LT(std::abs(r.value[0] - f.exact), 4 * r.standard_error[0])
                    << f.name << " by " << name << " " << seed << ": " << to_string(r);
            }
}

// A pole inside of several variables, whose values are not yet far above the mean when the target is reached.
TEST(SlowShells, PolesInsideEnterTheError) {
    const auto pole = [](std::span<const double> x) { return 1 / std::hypot(x[0] - 0.5, x[1] - 0.5); };
    const FirstLook look = first_look(Evaluator(Integrand(pole), Domain::unit_cube(2)), {.seed = 1});
    ASSERT_EQ(look.slow.size(), 2u); // on both diagonals, each with two of the four quadrants
    // 2 pi r lies closer than r.
    for (std::size_t i = 1; i < look.slow[0].shells.size(); ++i) {
        const double mass = look.slow[0].shells[i].value[0] * look.slow[0].shells[i].volume,
                     before = look.slow[0].shells[i - 1].value[0] * look.slow[0].shells[i - 1].volume;
        EXPECT_NEAR(std::log2(before / mass), look.slow[0].exponents[i] - look.slow[0].exponents[i - 1],
                    0.01);
    }
    const std::vector<Unreached> missed = unreached(look.slow, 1, nullptr, 10'000);
    EXPECT_GT(missed[0].mass, 0.5 * 2 * std::numbers::pi * 0.0056); // pi r^2 holds one point
    EXPECT_LT(missed[0].mass, 4 * 2 * std::numbers::pi * 0.0056);
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        const IntegrationResult r =
            integrate(pole, Domain::unit_cube(2), Method::named("quasi"),
                      {.relative_error = 1e-2, .evaluations = 200'000}, {.seed = seed, .threads = 1});
        EXPECT_LT(std::abs(r.value[0] - 3.5254943480781720), 4 * r.standard_error[0]) << seed << to_string(r);
    }
}

} // namespace
} // namespace montelux
