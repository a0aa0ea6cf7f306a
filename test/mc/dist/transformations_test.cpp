#include "test/significance.h"
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/dist/affine.h"
#include "montelux/mc/dist/families.h"
#include "montelux/mc/dist/mixture.h"
#include "montelux/mc/dist/truncated.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/z_test.h"

namespace montelux {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

// Samples against the pdf; quantiles against cdf in both tails. `absolute`: the error of P where ends cut
// through the bulk of a law.
template <TwoTailedDistribution1D D>
void expect_consistent(const D& d, double from, double to, double absolute = 0) {
    auto r =
        interval_chi_squared_test([&](double xi) { return d.sample(xi); }, [&](double x) { return d.pdf(x); },
                                  from, to, {.samples = 50000, .cells_x = 60});
    EXPECT_TRUE(r.passes(significance)) << r.description;
    for (double p : {1e-12, 1e-4, 0.1, 0.4, 0.5, 0.8, 0.999}) {
        double low = d.quantile(p), high = d.quantile_complement(p);
        EXPECT_NEAR(d.cdf(low), p, 1e-12 * p + 1e-15 * std::abs(low) * d.pdf(low) + absolute);
        EXPECT_NEAR(d.cdf_complement(high), p, 1e-12 * p + 1e-15 * std::abs(high) * d.pdf(high) + absolute);
        EXPECT_NEAR(d.cdf(high) + d.cdf_complement(high), 1, 1e-14);
    }
}

TEST(Truncated, RestrictsAndRenormalises) {
    Truncated d(NormalDistribution(1, 2), 0, 4);
    expect_consistent(d, 0, 4, 1e-15);
    NormalDistribution n(1, 2);
    EXPECT_NEAR(d.mass(), n.cdf(4) - n.cdf(0), 1e-15);
    EXPECT_NEAR(d.pdf(2), n.pdf(2) / d.mass(), 1e-15);
    EXPECT_EQ(d.pdf(-0.1), 0);
    EXPECT_EQ(d.pdf(4.1), 0);
    EXPECT_EQ(d.quantile(0), 0);
    EXPECT_EQ(d.quantile(1), 4);
    // The ends of the support win over wider ones.
    Truncated waiting(ExponentialDistribution(5), -inf, 0.5);
    expect_consistent(waiting, 0, 0.5, 1e-15);
    EXPECT_EQ(waiting.lower(), 0);
    // p = 2v on [0, 4), restricted to [2, 4), is the linear law there.
    Truncated linear(LinearDistribution(0, 4), 2, 4);
    for (double xi : {0.0, 0.3, 0.9}) EXPECT_NEAR(linear.quantile(xi), 2 * std::sqrt(3 * xi + 1), 1e-14);
}

// Beyond 30 deviations 1 - cdf is 5e-198; the law of the excess is known from the asymptotic series, and the
// median here from 50 digits.
TEST(Truncated, FarTailsKeepTheirDigits) {
    Truncated right(NormalDistribution(), 30, inf), left(NormalDistribution(), -inf, -30);
    EXPECT_NEAR(right.mass() / 4.906713927148187e-198, 1, 1e-12);
    EXPECT_NEAR(right.quantile(0.5), 30.02307046782731, 1e-13);
    EXPECT_NEAR(left.quantile(0.5), -30.02307046782731, 1e-13);
    expect_consistent(right, 30, 30.4);
    expect_consistent(left, -30.4, -30);
}

TEST(Truncated, BadIntervalsGetASentence) {
    EXPECT_THROW(Truncated(NormalDistribution(), 1, 1), Error);
    EXPECT_THROW(Truncated(NormalDistribution(), 2, 1), Error);
    EXPECT_THROW(Truncated(NormalDistribution(), std::nan(""), 1), Error);
    EXPECT_THROW(Truncated(UniformDistribution(), 2, 3), Error);
    try {
        Truncated(NormalDistribution(), 50, 60);
        FAIL();
    } catch (const Error& e) {
        EXPECT_STREQ(e.what(),
                     "Truncated: lower = 50, upper = 60, probability = 0; expected an interval that has a "
                     "probability above zero");
    }
}

TEST(Affine, ShiftsScalesAndReflects) {
    Affine d(ExponentialDistribution(2), -3, 1);
    expect_consistent(d, -10, 1);
    EXPECT_EQ(d.upper(), 1);
    EXPECT_EQ(d.lower(), -inf);
    EXPECT_NEAR(d.pdf(-2), ExponentialDistribution(2).pdf(1) / 3, 1e-15);
    EXPECT_NEAR(d.quantile(1e-30), 1 - 3 * ExponentialDistribution(2).quantile_complement(1e-30), 1e-12);
    for (double x : {-2.0, 0.3, 5.0}) {
        NormalDistribution exact(1, 2);
        auto built = shifted(scaled(NormalDistribution(), 2), 1);
        EXPECT_DOUBLE_EQ(built.pdf(x), exact.pdf(x));
        EXPECT_DOUBLE_EQ(built.cdf(x), exact.cdf(x));
        EXPECT_DOUBLE_EQ(built.cdf_complement(x), exact.cdf_complement(x));
        EXPECT_DOUBLE_EQ(reflected(exact).cdf(x), NormalDistribution(-1, 2).cdf(x));
    }
    EXPECT_THROW(scaled(NormalDistribution(), 0), Error);
    EXPECT_THROW(shifted(NormalDistribution(), inf), Error);
}

TEST(Mixture, OfOneFamilyAndOfMany) {
    Mixture peaks({1, 3}, std::vector{NormalDistribution(-2, 0.5), NormalDistribution(3, 1)});
    expect_consistent(peaks, -6, 9);
    EXPECT_DOUBLE_EQ(peaks.weight(1), 0.75);
    EXPECT_NEAR(peaks.pdf(-2),
                0.25 * NormalDistribution(-2, 0.5).pdf(-2) + 0.75 * NormalDistribution(3).pdf(-2), 1e-15);
    Mixture<> defensive({0.9, 0.1, 0}, {NormalDistribution(0, 0.1), CauchyDistribution(0, 2),
                                        UniformDistribution(-1e9, 1e9)});
    expect_consistent(defensive, -3, 3);
    // A component of weight zero takes no part.
    EXPECT_NEAR(defensive.quantile(0.01), -std::abs(defensive.quantile_complement(0.01)), 1e-12);
    EXPECT_GT(defensive.quantile(0.01), -100);
    // Quantiles where sampling composes instead: the same law.
    TestUniforms uniforms(8);
    std::vector<double> values;
    values.reserve(5000);
    for (int i = 0; i < 5000; ++i) values.push_back(peaks.quantile(uniforms.next()));
    auto r = kolmogorov_smirnov_test(values, [&](double x) { return peaks.cdf(x); });
    EXPECT_TRUE(r.passes(significance)) << r.description;
    Mixture gap({1, 1}, std::vector{UniformDistribution(0, 1), UniformDistribution(10, 12)});
    EXPECT_NEAR(gap.quantile(0.25), 0.5, 1e-15);
    EXPECT_NEAR(gap.quantile(0.75), 11, 1e-14);
    EXPECT_EQ(gap.lower(), 0);
    EXPECT_EQ(gap.upper(), 12);
}

TEST(Mixture, BadWeightsGetASentence) {
    std::vector<NormalDistribution> two{NormalDistribution(), NormalDistribution()};
    EXPECT_THROW(Mixture({1}, two), Error);
    EXPECT_THROW(Mixture({1, -1}, two), Error);
    EXPECT_THROW(Mixture({0, 0}, two), Error);
    EXPECT_THROW(Mixture({}, std::vector<NormalDistribution>{}), Error);
}

} // namespace
} // namespace montelux
