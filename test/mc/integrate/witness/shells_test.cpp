#include "test/mc/integrate/witness/shell_values.h"
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "montelux/mc/integrate/witness/shells.h"

namespace montelux {
namespace {

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

// Numerators that cancellation rounds to zero long before the finest shell, beside values that end there in truth.
TEST(Shells, DigitsLostByCancellationAreToldFromEnds) {
    const auto cosine = [](double r) { return 1 - std::cos(r); };
    const auto sine = [](double r) { return r - std::sin(r); };
    const auto square_root = [](double r) { return std::sqrt(1 + r) - 1; };
    const auto exponentials = [](double r) { return std::exp(-r) - std::exp(-3 * r); };
    const auto root_cosine = [](double r) { return 1 - std::cos(std::sqrt(r)); };
    for (double finest : {46.0, finest_at_origin}) {
        const auto over = [=](auto numerator, double power, int codimension = 1) {
            return masses_diverge(of([=](double r) { return numerator(r) / std::pow(r, power); }), finest,
                                  codimension);
        };
        EXPECT_TRUE(over(cosine, 3));
        EXPECT_TRUE(over(cosine, 3.4));
        EXPECT_FALSE(over(cosine, 2.95));
        EXPECT_TRUE(over(sine, 4));
        EXPECT_FALSE(over(sine, 3.9));
        EXPECT_TRUE(over(cosine, 4, 2));
        EXPECT_FALSE(over(cosine, 3.9, 2));
        for (double cut : {1e-3, 1e-6, 1e-9, 1e-12}) {
            const auto up_to = [=](auto f) { return of([=](double r) { return r > cut ? f(r) / r : 0; }); };
            EXPECT_FALSE(masses_diverge(up_to([](double) { return 1.0; }), finest, 1)) << cut;
            EXPECT_FALSE(masses_diverge(up_to([](double r) { return std::abs(std::sin(1 / r)); }), finest, 1))
                << cut;
            EXPECT_FALSE(masses_diverge(up_to([](double r) { return std::log1p(1 / r); }), finest, 1)) << cut;
        }
        if (finest < 53) continue; // beyond the digits of first order
        EXPECT_TRUE(over(square_root, 2));
        EXPECT_FALSE(over(square_root, 1.9));
        EXPECT_TRUE(over(exponentials, 2));
        EXPECT_FALSE(over(exponentials, 1.9));
        EXPECT_TRUE(over(root_cosine, 2));
        EXPECT_FALSE(over(root_cosine, 1.9));
        EXPECT_FALSE(masses_diverge(of([](double r) { return r > 1e-25 ? 1 / r : 0; }), finest, 1));
    }
}

// Sums of terms that cancel are noise close to zero, whose masses grow.
TEST(Shells, NoiseDoesNotDecide) {
    const auto exponential = [](double r) { return std::abs(std::exp(r) - 1 - r); };
    const auto hyperbolic_sine = [](double r) { return std::abs(std::exp(r) - std::exp(-r) - 2 * r); };
    for (double finest : {46.0, finest_at_origin})
        for (int codimension : {1, 2}) {
            const auto over = [=](auto numerator, double power) {
                return masses_diverge(
                    of([=](double r) { return numerator(r) / std::pow(r, power + codimension); }), finest,
                    codimension);
            };
            for (double power : {1.4, 1.7, 1.9}) EXPECT_FALSE(over(exponential, power)) << power;
            for (double power : {2.0, 2.3}) EXPECT_TRUE(over(exponential, power)) << power;
            for (double power : {2.4, 2.7, 2.9}) EXPECT_FALSE(over(hyperbolic_sine, power)) << power;
            for (double power : {3.0, 3.3}) EXPECT_TRUE(over(hyperbolic_sine, power)) << power;
        }
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
    // A jump, as at a point beside the place where cancellation rounds a term to zero.
    for (double exponent = 30; exponent < 44.5; exponent += 0.5)
        EXPECT_FALSE(masses_diverge(of([=](double r) { return r < std::exp2(-exponent) ? 1e6 : 10; }), 46, 1))
            << exponent;
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
