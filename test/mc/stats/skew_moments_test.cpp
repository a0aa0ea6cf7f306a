#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/mc/stats/skew_moments.h"

namespace montelux {
namespace {

TEST(SkewMoments, AgreesWithTwoPassesAndMerges) {
    TestUniforms u(1);
    std::vector<double> x;
    for (int i = 0; i < 1000; ++i) x.push_back(1000 - std::log1p(-u.next()));
    SkewMoments<1> all, first, second;
    for (std::size_t i = 0; i < x.size(); ++i) {
        all.add(std::array{x[i]});
        (i < 300 ? first : second).add(std::array{x[i]});
    }
    double mean = 0, m2 = 0, m3 = 0;
    for (double v : x) mean += v / 1000;
    for (double v : x) {
        m2 += (v - mean) * (v - mean) / 1000;
        m3 += (v - mean) * (v - mean) * (v - mean) / 1000;
    }
    first.merge(second);
    for (const auto& m : {all, first}) {
        EXPECT_EQ(m.count(), 1000u);
        EXPECT_NEAR(m.mean(), mean, 1e-9);
        EXPECT_NEAR(m.variance(), m2 * 1000 / 999, 1e-9);
        EXPECT_NEAR(m.skewness(), m3 / std::pow(m2, 1.5), 1e-9);
        EXPECT_NEAR(m.skewness_of_mean(), m.skewness() / std::sqrt(1000.0), 1e-12);
    }
}

TEST(SkewMoments, SaysNothingFromTooFewSamples) {
    SkewMoments<1> m;
    EXPECT_TRUE(std::isinf(m.standard_error()));
    m.add(std::array{1.0});
    EXPECT_TRUE(std::isinf(m.standard_error()));
    EXPECT_EQ(m.skewness(), 0);
}

// Means of 64 exponential samples (skewness 2): plain scores lean to the negative side by 2 / (2 * 8),
// corrected ones do not. 20,000 means distinguish 0.125 from 0 at 17 standard errors; the bounds are 5 wide.
TEST(SkewMoments, CorrectedScoresAreCentred) {
    TestUniforms u(2);
    RunningMoments plain, corrected;
    for (int k = 0; k < 20000; ++k) {
        SkewMoments<1> m;
        for (int i = 0; i < 64; ++i) m.add(std::array{-std::log1p(-u.next())});
        double z = (m.mean() - 1) / m.standard_error();
        plain.add(z);
        corrected.add(skew_corrected_z(z, m.skewness_of_mean()));
    }
    EXPECT_NEAR(plain.mean(), -0.125, 0.04);
    EXPECT_NEAR(corrected.mean(), 0, 0.04);
    EXPECT_NEAR(corrected.standard_deviation(), 1, 0.06);
}

} // namespace
} // namespace montelux
