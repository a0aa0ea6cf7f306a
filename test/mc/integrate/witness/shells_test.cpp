#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

#include "montelux/mc/integrate/witness/shells.h"

namespace montelux {
namespace {

// |g| at distance r = 2^-k from a formula in r.
template <typename F>
ShellValues of(F f) {
    return [f](std::span<const double> exponents) {
        std::vector<double> g;
        for (double k : exponents) g.push_back(f(std::exp2(-k)));
        return g;
    };
}

TEST(Shells, PowersDivergeFromTheCodimensionOn) {
    for (int codimension : {1, 2, 3}) {
        const double c = codimension;
        EXPECT_TRUE(masses_diverge(of([=](double r) { return std::pow(r, -c); }), 46, codimension));
        EXPECT_TRUE(masses_diverge(of([=](double r) { return std::pow(r, -c - 0.5); }), 46, codimension));
        EXPECT_FALSE(masses_diverge(of([=](double r) { return std::pow(r, -c + 0.1); }), 46, codimension));
        EXPECT_FALSE(masses_diverge(of([](double) { return 1.0; }), 46, codimension));
    }
    EXPECT_FALSE(masses_diverge(of([](double r) { return std::pow(r, -0.99); }), finest_at_origin, 1));
}

TEST(Shells, LogarithmsDecideByCondensation) {
    EXPECT_TRUE(masses_diverge(of([](double r) { return 1 / (r * std::abs(std::log(r))); }), 46, 1));
    EXPECT_FALSE(masses_diverge(of([](double r) { return 1 / (r * std::pow(std::log(r), 2)); }), 46, 1));
    EXPECT_TRUE(masses_diverge(of([](double r) { return std::abs(std::log(r)) / r; }), 46, 1));
}

TEST(Shells, RoundingDoesNotDecide) {
    // 1 / (1 - cos r) diverges for one variable and converges for three; below 1e-8 the cosine is rounded to one.
    const ShellValues g = of([](double r) { return 1 / (1 - std::cos(r)); });
    EXPECT_TRUE(masses_diverge(g, 46, 1));
    EXPECT_FALSE(masses_diverge(g, 46, 3));
    // Beyond the smallest shells that a value was seen in, there is nothing.
    EXPECT_FALSE(masses_diverge(of([](double r) { return r > 1e-3 ? 1 / std::sqrt(r) : 0; }), 46, 1));
    EXPECT_FALSE(masses_diverge(of([](double) { return std::numeric_limits<double>::quiet_NaN(); }), 46, 1));
    // A plateau inside of a gap.
    EXPECT_FALSE(masses_diverge(of([](double r) { return r < 1e-9 ? 1.0 : 0.0; }), 46, 1));
}

// A peak a few octaves wider than the finest shell: masses grow up to its width, and no pole's values stay as they are.
TEST(Shells, NarrowPeaksAreNoPoles) {
    for (double width : {0x1p-36, 0x1p-40, 0x1p-43})
        for (int codimension : {1, 2}) {
            EXPECT_FALSE(masses_diverge(of([=](double r) { return std::exp(-r * r / (width * width)); }), 46,
                                        codimension));
            EXPECT_FALSE(
                masses_diverge(of([=](double r) { return 1 / (r * r + width * width); }), 46, codimension))
                << width;
        }
}

TEST(Shells, DistancesStayAboveTheSpacingOfDoubles) {
    const Domain unit = Domain::interval(0, 1), far = Domain::interval(1e6, 1e6 + 1),
                 shifted = Domain::interval(1, 2);
    EXPECT_EQ(finest_exponent(unit, 0, 0), finest_at_origin);
    EXPECT_EQ(finest_exponent(unit, 0, 0.5), finest_inside);
    EXPECT_NEAR(finest_exponent(far, 0, 0.5), finest_inside - std::log2(1e6), 1e-3);
    EXPECT_EQ(finest_exponent(shifted, 0, 0), finest_inside);
}

} // namespace
} // namespace montelux
