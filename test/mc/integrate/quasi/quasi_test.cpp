// A6: randomised quasi-Monte Carlo on every point set.
#include "test/mc/integrate/estimator_checks.h"
#include <gtest/gtest.h>

#include "montelux/mc/integrate/quasi/quasi.h"
#include "montelux/mc/integrate/quasi/randomised_points.h"
#include "montelux/mc/math/constants.h"

namespace montelux {
namespace {

KnownIntegral product(int dimensions) {
    return {[](std::span<const double> x) {
                double y = 1;
                for (double v : x) y *= pi / 2 * std::sin(pi * v);
                return y;
            },
            Domain::unit_cube(dimensions),
            {1}};
}

std::vector<Quasi> randomised_sets() {
    using enum PointSetKind;
    std::vector<Quasi> sets;
    for (PointSetKind kind : {sobol, halton, hammersley, golden_ratio, weyl, independent})
        sets.push_back({.points = kind});
    for (PointSetKind kind : {sobol, halton, hammersley}) sets.push_back({kind, Randomisation::shift});
    for (PointSetKind kind : {halton, hammersley}) sets.push_back({kind, Randomisation::digit_permutation});
    return sets;
}

TEST(Quasi, EverySetIsUnbiasedWithAnHonestError) {
    for (const Quasi& set : randomised_sets()) {
        RunningMoments values, squared_errors;
        for (std::uint64_t seed = 0; seed < 200; ++seed) {
            const KnownIntegral f = product(3);
            const IntegrationResult r =
                integrate(f.f, f.domain, set, {.evaluations = 2100}, {.seed = seed, .threads = 1});
            values.add(r.value[0]);
            squared_errors.add(r.standard_error[0] * r.standard_error[0]);
            ASSERT_GT(r.evaluations, 1500u);
            ASSERT_LE(r.evaluations, 2100u);
        }
        const TestResult bias = unbiasedness_test(values, 1);
        EXPECT_TRUE(bias.passes(significance)) << to_string(set.points) << ": " << bias.description;
        // The squared standard error is unbiased for the variance that the seeds show; that variance is known
        // to sqrt(2 / 200), five of which are 50 %.
        EXPECT_NEAR(squared_errors.mean() / values.variance(), 1, 0.55) << to_string(set.points);
        // Random points would have sqrt(((pi^2 / 8)^3 - 1) / 2000).
        const double random = std::sqrt((std::pow(pi * pi / 8, 3) - 1) / 2000);
        if (set.points != PointSetKind::independent) {
            EXPECT_LT(values.standard_deviation(), 0.5 * random) << to_string(set.points);
        }
    }
}

TEST(Quasi, CalibratedByStudentsLaw) {
    // 16 replicates of 64 points, and 17 of 128 that the budget suggests.
    expect_unbiased_and_calibrated(product(4), Quasi{.replicates = 16}, {.evaluations = 1024}, 2000, 15);
    expect_unbiased_and_calibrated(product(4), Quasi{}, {.evaluations = 2200}, 1000, 16);
    expect_unbiased_and_calibrated(two_components(), Quasi{}, {.evaluations = 2200}, 600, 16);
}

TEST(Quasi, ErrorFallsFasterThanOneOverN) {
    auto deviation = [](std::uint64_t evaluations) {
        RunningMoments values;
        const KnownIntegral f = product(4);
        for (std::uint64_t seed = 0; seed < 100; ++seed)
            values.add(
                integrate(f.f, f.domain, Quasi{.replicates = 8}, {.evaluations = evaluations}, {.seed = seed})
                    .value[0]);
        return values.standard_deviation();
    };
    const double slope = std::log(deviation(16384) / deviation(1024)) / std::log(16.0);
    EXPECT_LT(slope, -1) << "random points would give -1/2";
}

TEST(Quasi, LimitedEvaluationsAreUsedWithBalancedNumbers) {
    const KnownIntegral f = product(2);
    for (std::uint64_t limit : {24u, 100u, 1000u, 5000u, 77777u, 1000000u}) {
        const IntegrationResult r = integrate(f.f, f.domain, Quasi{}, {.evaluations = limit});
        EXPECT_LE(r.evaluations, limit);
        EXPECT_GE(static_cast<double>(r.evaluations), 0.92 * static_cast<double>(limit));
        const IntegrationResult halton =
            integrate(f.f, f.domain, Quasi{.points = PointSetKind::halton}, {.evaluations = limit});
        EXPECT_LE(halton.evaluations, limit);
        EXPECT_GE(static_cast<double>(halton.evaluations), 0.6 * static_cast<double>(limit));
    }
    // As asked for: 10 replicates of 64 points, for 128 do not fit.
    EXPECT_EQ(integrate(f.f, f.domain, Quasi{.replicates = 10}, {.evaluations = 1200}).evaluations, 640u);
    EXPECT_THROW(integrate(f.f, f.domain, Quasi{.replicates = 10}, {.evaluations = 9}), Error);
}

TEST(Quasi, PlainSetsDoNotKnowTheirError) {
    using enum PointSetKind;
    const KnownIntegral f = product(2);
    for (PointSetKind kind : {sobol, halton, hammersley, golden_ratio, weyl}) {
        const Method plain = Quasi{kind, Randomisation::none};
        const IntegrationResult r = integrate(f.f, f.domain, plain, {.evaluations = 4096});
        EXPECT_FALSE(r.statistical);
        EXPECT_TRUE(std::isinf(r.standard_error[0]));
        EXPECT_NEAR(r.value[0], 1, 0.01);
        EXPECT_LE(r.evaluations, 4096u);
        EXPECT_EQ(r.value, integrate(f.f, f.domain, plain, {.evaluations = 4096}, {.seed = 5}).value);
        // The first point of most sets is a corner, which a map to infinity does not survive.
        const IntegrationResult infinite =
            integrate([](std::span<const double> x) { return std::exp(-x[0] * x[0] - x[1] * x[1]); },
                      Domain({{-INFINITY, INFINITY}, {0, INFINITY}}), plain, {.evaluations = 1 << 14});
        EXPECT_EQ(infinite.non_finite, 0u);
        EXPECT_NEAR(infinite.value[0], pi / 2, 0.02);
    }
}

// An error that is claimed and missed by far happens seldom: below 1 % of runs that stop at a target.
TEST(Quasi, TargetsAreMet) {
    int silent = 0, runs = 0;
    double claimed = 0;
    for (int d : {1, 2, 5}) {
        const KnownIntegral smooth = product(d);
        const KnownIntegral jump{[](std::span<const double> x) {
                                     double s = 0;
                                     for (double v : x) s += v;
                                     return s < 0.6 * static_cast<double>(x.size()) ? std::exp(-s) : 0.0;
                                 },
                                 Domain::unit_cube(d),
                                 {}};
        const double jump_truth =
            integrate(jump.f, jump.domain, Quasi{}, {.evaluations = 1 << 20}, {.seed = 999}).value[0];
        for (std::uint64_t seed = 0; seed < 60; ++seed)
            for (const KnownIntegral* f : {&smooth, &jump}) {
                const IntegrationResult r =
                    integrate(f->f, f->domain, Quasi{}, {.relative_error = 2e-3}, {.seed = seed});
                EXPECT_EQ(r.stop, StopReason::error_target);
                const double truth = f->truth.empty() ? jump_truth : 1;
                claimed = std::max(claimed, r.standard_error[0] / r.value[0]);
                silent += std::abs(r.value[0] / truth - 1) > 3 * 2e-3;
                ++runs;
            }
    }
    EXPECT_LE(claimed, 2e-3);
    EXPECT_LE(silent, runs / 100) << "of " << runs;
}

TEST(Quasi, WarnsOfWhatOneReplicateSaw) {
    // A spike that about one of 16 * 64 points sees.
    auto spike = [](std::span<const double> x) { return x[0] < 0.03 && x[1] < 0.03 ? 1000.0 : 1.0; };
    int warnings = 0;
    for (std::uint64_t seed = 0; seed < 50; ++seed)
        warnings += !integrate(spike, Domain::unit_cube(2), Quasi{}, {.evaluations = 1024}, {.seed = seed})
                         .warnings.empty();
    EXPECT_GT(warnings, 10);
    const IntegrationResult nothing = integrate([](std::span<const double>) { return 0.0; },
                                                Domain::unit_cube(2), Quasi{}, {.relative_error = 0.1});
    EXPECT_EQ(nothing.stop, StopReason::finished);
    EXPECT_TRUE(std::isinf(nothing.standard_error[0]));
    EXPECT_FALSE(nothing.converged());
}

// For values of one sign the mean equals the mean magnitude, whether sets grow or are replaced.
TEST(Quasi, MagnitudesAreThoseOfThePointsThatCount) {
    const KnownIntegral f = product(2);
    const Evaluator evaluator(f.f, f.domain);
    for (const Quasi& set : randomised_sets()) {
        auto estimator = Method(set).estimator({evaluator, 1});
        for (int doublings = 0; doublings < 3; ++doublings) {
            ASSERT_EQ(estimator->step({.max_evaluations = 1 << 20, .relative_error = 1e-30}),
                      StepOutcome::advanced);
            const Tally tally = estimator->tally();
            ASSERT_EQ(tally.absolute.size(), 1u);
            EXPECT_NEAR(tally.absolute[0], tally.value[0], 1e-12)
                << to_string(set.points) << ", " << doublings;
        }
    }
}

TEST(Quasi, KeepsPromises) {
    for (const Quasi& set : randomised_sets()) expect_keeps_promises(set, 3000);
    for (PointSetKind kind : {PointSetKind::sobol, PointSetKind::halton, PointSetKind::hammersley})
        expect_keeps_promises(Quasi{kind, Randomisation::none}, 3000);
}

TEST(QuasiSlowTest, ADoublingInSeveralStepsIsResumedAmidst) {
    expect_same_bits_after_resume(product(1), Quasi{.replicates = 2}, 1 << 22);
    expect_same_bits_after_resume(product(1), Quasi{.points = PointSetKind::hammersley, .replicates = 2},
                                  1 << 22);
}

TEST(Quasi, MistakesGiveAMessage) {
    auto one = [](std::span<const double>) { return 1.0; };
    EXPECT_THROW(integrate(one, Domain::unit_cube(2), Quasi{.replicates = 1}), Error);
    EXPECT_THROW(integrate(one, Domain::unit_cube(2), Quasi{.replicates = -4}), Error);
    EXPECT_THROW(integrate(one, Domain::unit_cube(10000), Quasi{}), Error);
    EXPECT_THROW(integrate(one, Domain::unit_cube(2), Quasi{PointSetKind::weyl, Randomisation::scramble}),
                 Error);
}

TEST(RandomisedPoints, ReplicatesDiffer) {
    for (auto [kind, r] : {std::pair(PointSetKind::sobol, Randomisation::scramble),
                           std::pair(PointSetKind::golden_ratio, Randomisation::shift),
                           std::pair(PointSetKind::independent, Randomisation::none)}) {
        auto point = [&](std::uint32_t replicate, std::uint64_t index) {
            PointBuffer u(1, 2);
            RandomisedPoints(kind, r, 2, 64, 1, replicate).fill(u, index);
            return std::pair(u(0, 0), u(0, 1));
        };
        EXPECT_NE(point(0, 5), point(1, 5));
        EXPECT_NE(point(0, 5), point(0, 6));
        EXPECT_NE(point(0, 5).first, point(0, 5).second);
        EXPECT_EQ(point(3, 5), point(3, 5));
    }
}

} // namespace
} // namespace montelux
