#include <cmath>
#include <gtest/gtest.h>
#include <sstream>
#include <vector>

#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/estimate.h"
#include "montelux/mc/stats/moments.h"

namespace montelux {
namespace {

TEST(RunningMoments, ClosedFormOfAnArithmeticSequence) {
    RunningMoments m;
    for (int i = 1; i <= 100; ++i) m.add(i);
    EXPECT_EQ(m.count(), 100u);
    EXPECT_DOUBLE_EQ(m.mean(), 50.5);
    EXPECT_NEAR(m.variance(), 100 * 101 / 12.0, 1e-10);
    EXPECT_NEAR(m.standard_error(), std::sqrt(101 / 12.0), 1e-12);
    EXPECT_NEAR(m.sum(), 5050, 1e-10);
}

TEST(RunningMoments, LargeOffsetKeepsTheVariance) {
    RunningMoments m;
    for (int i = 0; i < 1000; ++i) m.add(1e9 + i % 2);
    EXPECT_NEAR(m.variance(), 0.25 * 1000 / 999, 1e-6); // sum of squares would lose all of it
}

TEST(RunningMoments, MergingAnyGroupingAgrees) {
    TestUniforms u(3);
    RunningMoments whole, parts[7];
    for (int i = 0; i < 10000; ++i) {
        double x = u.next();
        whole.add(x);
        parts[static_cast<int>(u.next() * 6)].add(x); // the seventh stays empty
    }
    RunningMoments merged;
    for (const auto& p : parts) merged.merge(p);
    EXPECT_EQ(merged.count(), whole.count());
    EXPECT_NEAR(merged.mean(), whole.mean(), 1e-14);
    EXPECT_NEAR(merged.variance(), whole.variance(), 1e-14);
}

TEST(RunningMoments, FewSamplesHaveNoKnownError) {
    RunningMoments m;
    EXPECT_TRUE(std::isinf(m.variance()));
    m.add(2);
    EXPECT_EQ(m.mean(), 2);
    EXPECT_TRUE(std::isinf(m.standard_error()));
}

TEST(Moments3, ChannelsAreIndependentAndStateRestores) {
    Moments3 m;
    m.add(Vec3f{1, 10, 0});
    m.add(Vec3f{3, 10, -4});
    EXPECT_DOUBLE_EQ(m.variance(0), 2);
    EXPECT_DOUBLE_EQ(m.variance(1), 0);
    EXPECT_DOUBLE_EQ(m.mean(2), -2);
    EXPECT_EQ(Moments3(m.count(), m.means(), m.squared_deviations()), m);
    static_assert(sizeof(Moments3) == 56);
}

TEST(Estimate, PrintsConciseNotation) {
    auto text = [](double v, double e) { return to_string(Estimate{v, e, 10}); };
    EXPECT_EQ(text(1.23452, 0.0067), "1.2345(67)");
    EXPECT_EQ(text(1.23452, 0.00996), "1.235(10)");
    EXPECT_EQ(text(-0.5, 0.12), "-0.50(12)");
    EXPECT_EQ(text(0, 0.25), "0.00(25)");
    EXPECT_EQ(text(123456, 78), "123456(78)");
    EXPECT_EQ(text(123456, 780), "1.2346(78)e5");
    EXPECT_EQ(text(1.5e-9, 2.5e-11), "1.500(25)e-9");
    EXPECT_EQ(text(2, 0), "2(0)");
    EXPECT_EQ(text(2, INFINITY), "2(?)");
    std::ostringstream s;
    s << Estimate{1, 0.1, 10, 3};
    EXPECT_EQ(s.str(), "1.00(10) [3 non-finite]");
    EXPECT_EQ(to_string(Estimate{1, 0.1, 10, 1}), "1.00(10) [1 non-finite]");
    EXPECT_EQ(to_string(Estimate{1, 0.1, 10, 0}), "1.00(10)");
}

TEST(Estimate, ConfidenceIntervalIsNormal) {
    Interval i = Estimate{10, 2, 100}.confidence_interval(0.95);
    EXPECT_NEAR(i.lower, 10 - 2 * 1.959963984540054, 1e-12);
    EXPECT_TRUE(i.contains(13.9));
    EXPECT_FALSE(i.contains(14));
}

} // namespace
} // namespace montelux
