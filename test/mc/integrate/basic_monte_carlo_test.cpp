// A2, A9: basic Monte Carlo, in one and more dimensions.
#include "test/mc/integrate/estimator_checks.h"
#include <gtest/gtest.h>

#include "montelux/mc/integrate/basic_monte_carlo.h"
#include "montelux/mc/math/constants.h"

namespace montelux {
namespace {

const auto sine = [](double x) { return std::sin(x); };
const Domain quarter = Domain::interval(0, pi / 2);

TEST(BasicMonteCarlo, UnbiasedAndCalibrated) {
    // Enough seeds that a standard error 7% off is seen.
    expect_unbiased_and_calibrated({sine, quarter, {1}}, BasicMonteCarlo{}, {.evaluations = 1000}, 8000);
    expect_unbiased_and_calibrated(two_components(), BasicMonteCarlo{}, {.evaluations = 2000}, 1000);
}

TEST(BasicMonteCarlo, FourTimesTheSamplesHalveTheError) {
    // The true error, from the spread over seeds: slope -1/2 over a factor of 256 in N.
    auto value = [](std::uint64_t evaluations, std::uint64_t seed) {
        return integrate(sine, quarter, BasicMonteCarlo{}, {.evaluations = evaluations}, {.seed = seed})
            .value[0];
    };
    RunningMoments few, many;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        few.add(value(64, seed));
        many.add(value(64 * 256, seed));
    }
    const double slope = std::log(many.standard_deviation() / few.standard_deviation()) / std::log(256.0);
    // Each logarithm of a deviation is off by 1 / sqrt(2 * 400); five of those of the difference.
    EXPECT_NEAR(slope, -0.5, 5 * std::sqrt(2.0 / 800) / std::log(256.0));
}

TEST(BasicMonteCarlo, BoxInThreeDimensions) {
    auto f = [](std::span<const double> x) { return x[0] * x[1] * x[1] * std::exp(x[2]); };
    const double truth = (2 * 2 - 1) / 2.0 * 9 * (std::exp(1) - std::exp(-1));
    const IntegrationResult r = integrate(f, Domain({{1, 2}, {0, 3}, {-1, 1}}), BasicMonteCarlo{},
                                          {.evaluations = 200000}, {.seed = 3});
    const TestResult test = unbiasedness_test(r.estimate(), truth);
    EXPECT_TRUE(test.passes(significance)) << test.description;
    EXPECT_LT(r.estimate().relative_error(), 0.01);
    EXPECT_EQ(r.evaluations, 200000u);
}

TEST(BasicMonteCarlo, CovarianceOfComponents) {
    // x and 2 - x: variances 1/12, covariance -1/12.
    auto f = Integrand::vector_valued(2, [](std::span<const double> x, std::span<double> y) {
        y[0] = x[0];
        y[1] = 2 - x[0];
    });
    const IntegrationResult r =
        integrate(f, Domain::unit_cube(1), BasicMonteCarlo{}, {.evaluations = 1 << 16});
    ASSERT_EQ(r.covariance.size(), 4u);
    EXPECT_NEAR(r.covariance[1] * (1 << 16), -1 / 12.0, 2e-3);
    EXPECT_DOUBLE_EQ(r.covariance[1], r.covariance[2]);
    EXPECT_NEAR(r.covariance[0], r.standard_error[0] * r.standard_error[0], 1e-18);
}

TEST(BasicMonteCarlo, KeepsPromises) {
    expect_keeps_promises(BasicMonteCarlo{}, 30000);
    const IntegrationResult a = integrate(sine, quarter, BasicMonteCarlo{}, {.evaluations = 1000},
                                          {.seed = 8}),
                            b = integrate(sine, quarter, BasicMonteCarlo{}, {.evaluations = 1000},
                                          {.seed = 9});
    EXPECT_NE(a.value, b.value);
}

TEST(BasicMonteCarlo, NonFiniteSamplesAreLeftOutCountedAndLocated) {
    auto f = [](double x) { return x < 0.25 ? std::nan("") : 1.0; };
    const IntegrationResult r =
        integrate(f, Domain::unit_cube(1), BasicMonteCarlo{}, {.evaluations = 40000}, {.seed = 1});
    EXPECT_NEAR(r.value[0], 0.75, 0.02);
    EXPECT_NEAR(static_cast<double>(r.non_finite), 10000, 500);
    ASSERT_EQ(r.first_non_finite_point.size(), 1u);
    EXPECT_LT(r.first_non_finite_point[0], 0.25);
}

} // namespace
} // namespace montelux
