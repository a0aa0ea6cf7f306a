#include <gtest/gtest.h>

#include "montelux/mc/dist/inverse_table_1d.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/moments.h"

namespace montelux {
namespace {

InverseTable1D bell() {
    std::vector<double> f;
    for (int i = 0; i <= 100; ++i) f.push_back(std::exp(-8 * (i / 50.0 - 1) * (i / 50.0 - 1)) + 1e-3);
    return InverseTable1D(PiecewiseLinear1D(f, -1, 1), 64);
}

// False alarm: 1e-8.
TEST(InverseTable1D, SamplesFollowThePdf) {
    InverseTable1D table = bell();
    auto r =
        interval_chi_squared_test([&](double u) { return double(table.sample(static_cast<float>(u)).x); },
                                  [&](double x) { return double(table.pdf(static_cast<float>(x))); }, -1, 1);
    EXPECT_TRUE(r.passes(1e-8)) << r.description;
}

TEST(InverseTable1D, ReportsTheDensityOfItsPiece) {
    InverseTable1D table = bell();
    for (int i = 0; i < 1000; ++i) {
        auto s = table.sample((static_cast<float>(i) + 0.5f) / 1000);
        EXPECT_NEAR(table.pdf(s.x) * s.inverse_pdf, 1, 1e-5);
    }
    EXPECT_EQ(table.pdf(-1.1f), 0);
    EXPECT_EQ(table.pdf(1.0f), 0);
}

// Weights f / pdf average to the integral of f, here of x^2 over [-1, 1]. 5 standard errors: 6e-7.
TEST(InverseTable1D, WeightsAreUnbiased) {
    InverseTable1D table = bell();
    TestUniforms u(1);
    RunningMoments m;
    for (int i = 0; i < 200000; ++i) {
        auto s = table.sample(u.next_float());
        m.add(double(s.x * s.x * s.inverse_pdf));
    }
    EXPECT_NEAR(m.mean(), 2.0 / 3, 5 * m.standard_error());
}

} // namespace
} // namespace montelux
