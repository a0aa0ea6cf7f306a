#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "montelux/spectrum/sampled_spectrum.h"

namespace montelux {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

TEST(SampledSpectrum, ArithmeticIsLaneByLane) {
    SampledSpectrum a(1, 2, 3, 4), b(8, 4, 2, 1);
    EXPECT_EQ(a + b, SampledSpectrum(9, 6, 5, 5));
    EXPECT_EQ(a - b, SampledSpectrum(-7, -2, 1, 3));
    EXPECT_EQ(a * b, SampledSpectrum(8, 8, 6, 4));
    EXPECT_EQ(b / a, SampledSpectrum(8, 2, 2.0f / 3, 0.25f));
    EXPECT_EQ(2 * a, SampledSpectrum(2, 4, 6, 8));
    EXPECT_EQ(a * 2, 2 * a);
    EXPECT_EQ(a / 2, SampledSpectrum(0.5f, 1, 1.5f, 2));
    EXPECT_EQ(1.0f - a, SampledSpectrum(0, -1, -2, -3));
    EXPECT_EQ(lerp(0.25f, a, b), SampledSpectrum(2.75f, 2.5f, 2.75f, 3.25f));
    EXPECT_FALSE(a == SampledSpectrum(1, 2, 3, 5));
}

TEST(SampledSpectrum, SafeDivisionGivesZeroForZero) {
    EXPECT_EQ(safe_div(SampledSpectrum(1, 2, 0, 4), SampledSpectrum(0, 4, 0, -2)),
              SampledSpectrum(0, 0.5f, 0, -2));
}

TEST(SampledSpectrum, ReductionsSeeEveryLane) {
    for (int i = 0; i < 4; ++i) {
        SampledSpectrum s(2);
        s.set(i, 10);
        EXPECT_EQ(max_value(s), 10);
        EXPECT_EQ(average(s), 4);
        s.set(i, -1);
        EXPECT_EQ(min_value(s), -1);
        EXPECT_TRUE(has_negative(s));
        EXPECT_EQ(clamp_zero(s)[i], 0);
        s.set(i, nan);
        EXPECT_TRUE(has_nan(s));
        EXPECT_FALSE(all_finite(s));
        EXPECT_FALSE(is_black(s));
        s.set(i, infinity);
        EXPECT_FALSE(has_nan(s));
        EXPECT_FALSE(all_finite(s));
        SampledSpectrum black;
        EXPECT_TRUE(is_black(black));
        black.set(i, -1e-38f);
        EXPECT_FALSE(is_black(black));
    }
    EXPECT_TRUE(all_finite(SampledSpectrum(1)));
}

TEST(SampledSpectrum, ExponentialAndRootAreAccurate) {
    for (double x = -86; x < 88; x += 0.0137) {
        float argument = static_cast<float>(x);
        double truth = std::exp(static_cast<double>(argument));
        EXPECT_NEAR(exp(SampledSpectrum(argument))[2] / truth, 1, 3e-7) << x;
    }
    EXPECT_EQ(exp(SampledSpectrum(0, -1000, 1000, -infinity)), SampledSpectrum(1, 0, infinity, 0));
    EXPECT_TRUE(has_nan(exp(SampledSpectrum(nan))));
    EXPECT_EQ(sqrt(SampledSpectrum(0, 1, 4, 9)), SampledSpectrum(0, 1, 2, 3));
}

TEST(SampledSpectrum, InverseHyperbolicTangentIsAccurate) {
    for (double x = -0.9999; x <= 0.9999; x += 1.37e-5) {
        float argument = static_cast<float>(x);
        double truth = std::atanh(static_cast<double>(argument));
        EXPECT_NEAR(artanh(broadcast(argument))[1], truth, 3e-7 * std::max(1.0, std::abs(truth))) << x;
    }
}

} // namespace
} // namespace montelux
