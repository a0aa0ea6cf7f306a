#include "test/mc/integrate/adaptive/adaptive_problems.h"
#include "test/mc/integrate/coverage.h"
#include "test/mc/integrate/estimator_checks.h"
#include <atomic>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

#include "montelux/mc/integrate/adaptive/adaptive.h"
#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// Runs with a warning count in the mean, but not in the shares.
void expect_unbiased_and_honest(const KnownIntegral& problem, int most_warned) {
    const int seeds = 200;
    RunningMoments values;
    int one = 0, two = 0, judged = 0;
    for (int seed = 0; seed < seeds; ++seed) {
        const IntegrationResult r = integrate(problem.f, problem.domain, Adaptive{}, {.evaluations = 20'000},
                                              {.seed = static_cast<std::uint64_t>(seed), .threads = 1});
        ASSERT_LE(r.evaluations, 20'000u);
        ASSERT_GT(r.evaluations, 10'000u);
        values.add(r.value[0]);
        if (!r.warnings.empty()) continue;
        const double deviation = std::abs(r.value[0] - problem.truth[0]);
        ++judged;
        one += deviation <= r.standard_error[0];
        two += deviation <= 2 * r.standard_error[0];
    }
    const TestResult bias = unbiasedness_test(values, problem.truth[0]);
    EXPECT_TRUE(bias.passes(significance)) << bias.description;
    EXPECT_LE(seeds - judged, most_warned);
    expect_honest_errors(one, two, judged);
}

TEST(AdaptiveSlowTest, UnbiasedWithHonestErrorsForSmoothIntegrands) {
    expect_unbiased_and_honest(smooth(), 5);
}
TEST(AdaptiveSlowTest, UnbiasedWithHonestErrorsForJumps) { expect_unbiased_and_honest(discontinuous(), 30); }
TEST(AdaptiveSlowTest, UnbiasedWithHonestErrorsForTwoPeaks) { expect_unbiased_and_honest(two_peaks(4), 30); }

TEST(Adaptive, SameBitsForAnyThreads) {
    for (const KnownIntegral& problem : {smooth(), discontinuous(), two_peaks(5, 300), two_components()})
        expect_same_bits_for_any_threads(problem, Adaptive{}, 40'000);
}

TEST(Adaptive, NeverExceedsItsBudget) {
    for (const KnownIntegral& problem : {smooth(), discontinuous(), two_peaks(5, 300)}) {
        for (std::uint64_t evaluations : {1u, 15u})
            EXPECT_THROW(integrate(problem.f, problem.domain, Adaptive{}, {.evaluations = evaluations}),
                         Error);
        for (std::uint64_t evaluations : {16u, 17u, 100u, 1023u, 2048u, 5000u, 9999u, 20'000u, 50'001u}) {
            std::atomic<std::uint64_t> counted = 0;
            const Integrand f = problem.f.with_function([&](const PointBatch& x, ValueBatch y) {
                counted += x.count();
                problem.f(x, y);
            });
            const IntegrationResult r =
                integrate(f, problem.domain, Adaptive{}, {.evaluations = evaluations}, {.threads = 1});
            EXPECT_LE(r.evaluations, evaluations);
            EXPECT_EQ(r.evaluations, counted);
            EXPECT_EQ(r.stop, StopReason::evaluations);
            EXPECT_TRUE(std::isfinite(r.value[0]) && std::isfinite(r.standard_error[0]));
        }
    }
}

TEST(Adaptive, ReachesItsTargets) {
    for (const KnownIntegral& problem : {smooth(), discontinuous(), two_peaks(6, 300)})
        for (double error : {1e-2, 1e-3}) {
            const IntegrationResult r =
                integrate(problem.f, problem.domain, Adaptive{},
                          {.relative_error = error, .evaluations = 1'000'000}, {.seed = 2, .threads = 1});
            EXPECT_TRUE(r.converged()) << (r.warnings.empty() ? "" : r.warnings[0]);
            EXPECT_LE(r.standard_error[0], error * r.value[0]);
            EXPECT_LT(std::abs(r.value[0] - problem.truth[0]), 5 * error * problem.truth[0]);
            EXPECT_TRUE(r.statistical);
            EXPECT_EQ(r.method, "adaptive");
        }
}

// Peaks that uniform points hardly see: sigma 0.035 in 8 dimensions, a volume of 1e-8.
TEST(Adaptive, FindsNarrowPeaksInEightDimensions) {
    const KnownIntegral problem = two_peaks(8, 400);
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const IntegrationResult r = integrate(problem.f, problem.domain, Adaptive{}, {.evaluations = 60'000},
                                              {.seed = seed, .threads = 1});
        EXPECT_TRUE(r.warnings.empty()) << r.warnings[0];
        EXPECT_LT(r.standard_error[0], 0.01);
        EXPECT_LT(std::abs(r.value[0] - 2), 5 * r.standard_error[0]);
    }
}

// No run may be wrong without a warning, and most must converge.
void expect_found(const KnownIntegral& problem, int seeds, int least_converged) {
    int converged = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
        const IntegrationResult r =
            integrate(problem.f, problem.domain, Adaptive{}, {.relative_error = 1e-2, .evaluations = 400'000},
                      {.seed = static_cast<std::uint64_t>(seed), .threads = 1});
        converged += r.converged();
        if (!r.warnings.empty()) continue;
        EXPECT_LT(std::abs(r.value[0] - problem.truth[0]), 5 * r.standard_error[0]) << "seed " << seed;
    }
    EXPECT_GE(converged, least_converged);
}

// 25 peaks, among them twelve halves and quarters.
TEST(Adaptive, FindsAllPeaksOfAnEggbox) {
    auto f = [](std::span<const double> x) {
        return std::exp(std::pow(2 + std::cos(x[0] / 2) * std::cos(x[1] / 2), 5));
    };
    expect_found({f, Domain({{0, 10 * pi}, {0, 10 * pi}}), {2.66206e105}}, 5, 4);
}

TEST(Adaptive, FollowsThinRingsAndCurvedRidges) {
    const double width = 0.01, radius = 0.7;
    auto ring = [=](std::span<const double> x) {
        return std::exp(-0.5 * std::pow((std::hypot(x[0], x[1]) - radius) / width, 2));
    };
    const double truth = 2 * pi * radius * width * std::sqrt(2 * pi);
    expect_found({ring, Domain({{-1.3, 1.3}, {-1.3, 1.3}}), {truth}}, 4, 3);
    auto rosenbrock = [](std::span<const double> x) {
        return std::exp(-std::pow(1 - x[0], 2) - 100 * std::pow(x[1] - x[0] * x[0], 2));
    };
    expect_found({rosenbrock, Domain({{-5, 5}, {-5, 5}}), {0.301507}}, 4, 3);
}

// A ridge in five variables that bends to a side peak of 7 % at x_1 < 0. Without the check by walkers, 6 of
// 24 runs lose it.
TEST(AdaptiveSlowTest, FollowsARidgeInFiveVariables) {
    const double a = 0.8154, b = 98.95, truth = 4.132334e-4;
    auto f = [=](std::span<const double> x) {
        double exponent = 0;
        for (std::size_t j = 0; j + 1 < x.size(); ++j) {
            const double off = x[j + 1] - x[j] * x[j];
            exponent += (a - x[j]) * (a - x[j]) + b * off * off;
        }
        return std::exp(-exponent);
    };
    const std::vector<Range> ranges(5, {-4.903, 4.917});
    int lost = 0;
    for (std::uint64_t seed = 1; seed <= 24; ++seed) {
        const IntegrationResult r =
            integrate(f, Domain(ranges), Adaptive{}, {.relative_error = 1e-2, .evaluations = 1'000'000},
                      {.seed = seed, .threads = 1});
        lost += r.warnings.empty() && std::abs(r.value[0] - truth) > 4 * r.standard_error[0];
    }
    EXPECT_LE(lost, 3);
}

// Exploration and rounds of training shrink with the number of evaluations.
TEST(Adaptive, TrainsWithFiveThousandEvaluations) {
    const KnownIntegral problem = two_peaks(4);
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const IntegrationResult r = integrate(problem.f, problem.domain, Adaptive{}, {.evaluations = 5000},
                                              {.seed = seed, .threads = 1});
        EXPECT_LT(r.standard_error[0], 0.03) << "seed " << seed;
        EXPECT_LT(std::abs(r.value[0] - problem.truth[0]), 6 * r.standard_error[0]) << "seed " << seed;
    }
}

// Half of the integral in 1 / 5000 of the square: most explorations do not see it.
TEST(Adaptive, SpikesOnAPlateauAreSeldomMissed) {
    const double width = 0.005;
    auto f = [=](std::span<const double> x) {
        const double r2 = std::pow(x[0] - 0.317, 2) + std::pow(x[1] - 0.731, 2);
        return 1 + std::exp(-0.5 * r2 / (width * width)) / (2 * pi * width * width);
    };
    expect_found({f, Domain::unit_cube(2), {2}}, 4, 3);
}

TEST(Adaptive, ZeroIntegrandGivesAWarning) {
    auto zero = [](std::span<const double>) { return 0.0; };
    const IntegrationResult r = integrate(zero, Domain::unit_cube(3), Adaptive{},
                                          {.relative_error = 1e-3, .evaluations = 50'000}, {.threads = 1});
    EXPECT_EQ(r.value[0], 0);
    EXPECT_FALSE(r.converged());
    ASSERT_FALSE(r.warnings.empty());
    EXPECT_NE(r.warnings[0].find("zero at every point"), std::string::npos) << r.warnings[0];
    EXPECT_TRUE(std::isinf(r.standard_error[0]));
}

// (x_1 + x_2 + x_3 mod 1)^-0.8 has mean 5 and no variance; it follows no coordinate, so that no map helps.
TEST(Adaptive, HeavyTailsGiveAWarning) {
    auto f = [](std::span<const double> x) {
        const double sum = x[0] + x[1] + x[2];
        return std::pow(sum - std::floor(sum) + 1e-300, -0.8);
    };
    int warned = 0, wrong = 0;
    const int seeds = 8;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        const IntegrationResult r = integrate(f, Domain::unit_cube(3), Adaptive{}, {.evaluations = 50'000},
                                              {.seed = seed, .threads = 1});
        warned += !r.warnings.empty();
        wrong += r.warnings.empty() && std::abs(r.value[0] - 5) > 4 * r.standard_error[0];
    }
    EXPECT_GE(warned, seeds / 2);
    EXPECT_LE(wrong, seeds / 4);
}

TEST(Adaptive, CornersWhereSeveralCoordinatesVanishHaveFiniteVariance) {
    const KnownIntegral problem = two_loop_propagator();
    for (std::uint64_t seed : {1u, 2u}) {
        const IntegrationResult r =
            integrate(problem.f, problem.domain, Method::named("adaptive"),
                      {.relative_error = 5e-3, .evaluations = 300'000}, {.seed = seed});
        EXPECT_TRUE(r.converged()) << seed;
        EXPECT_LT(std::abs(r.value[0] - problem.truth[0]), 4.5 * r.standard_error[0]) << seed;
    }
}

TEST(Adaptive, ComponentsOfVeryDifferentSizeEachGetTheirError) {
    const Integrand f = Integrand::vector_valued(3, [](std::span<const double> x, std::span<double> y) {
        auto peak = [&](double centre) {
            double squares = 0;
            for (double v : x) squares += (v - centre) * (v - centre);
            return std::exp(-100 * squares);
        };
        y[0] = 1e9 * peak(0.3);
        y[1] = 1e-9 * peak(0.7);
        y[2] = -3e-18 * y[0];
    });
    const double root = 10, one = 0.5 * std::sqrt(pi) / root * (std::erf(0.3 * root) + std::erf(0.7 * root)),
                 truth = std::pow(one, 4);
    const std::vector<double> scale{1e9, 1e-9, -3e-9};
    RunningMoments values[2];
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        const IntegrationResult r = integrate(f, Domain::unit_cube(4), Adaptive{}, {.evaluations = 40'000},
                                              {.seed = seed, .threads = 1});
        ASSERT_EQ(r.covariance.size(), 9u);
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_LT(r.standard_error[c], 0.02 * truth * std::abs(scale[c]));
            EXPECT_NEAR(r.covariance[4 * c], r.standard_error[c] * r.standard_error[c],
                        1e-9 * r.covariance[4 * c]);
            for (std::size_t k = 0; k < c; ++k) {
                EXPECT_EQ(r.covariance[3 * c + k], r.covariance[3 * k + c]);
                EXPECT_LE(std::abs(r.covariance[3 * c + k]),
                          1.000001 * r.standard_error[c] * r.standard_error[k]);
            }
        }
        // The third is a multiple of the first.
        EXPECT_NEAR(r.covariance[2] / (r.standard_error[0] * r.standard_error[2]), -1, 1e-6);
        for (std::size_t c = 0; c < 2; ++c) values[c].add(r.value[c] / scale[c]);
    }
    for (const RunningMoments& v : values) {
        const TestResult bias = unbiasedness_test(v, truth);
        EXPECT_TRUE(bias.passes(significance)) << bias.description;
    }
}

TEST(Adaptive, InfiniteRanges) {
    const double infinity = std::numeric_limits<double>::infinity();
    auto f = [](std::span<const double> x) { return std::exp(-x[0] * x[0] - 3 * x[1]); };
    const IntegrationResult r = integrate(f, Domain({{-infinity, infinity}, {0, infinity}}), Adaptive{},
                                          {.relative_error = 1e-4}, {.threads = 1});
    EXPECT_TRUE(r.converged());
    EXPECT_LT(std::abs(r.value[0] - std::sqrt(pi) / 3), 5e-4 * r.value[0]);
}

TEST(Adaptive, ValuesThatAreNotFiniteAreCounted) {
    expect_non_finite_counted(Domain::unit_cube(2), Adaptive{}, 20'000);
}

TEST(Adaptive, OneDimension) {
    const IntegrationResult r = integrate([](double x) { return x < 0.3 ? std::exp(x) : 0.0; },
                                          Domain::interval(0, 1), Adaptive{}, {.evaluations = 20'000});
    EXPECT_LT(r.standard_error[0], 1e-3);
    EXPECT_LT(std::abs(r.value[0] - std::expm1(0.3)), 5 * r.standard_error[0]);
}

TEST(Adaptive, RefusesSettingsOutOfRange) {
    auto one = [](std::span<const double>) { return 1.0; };
    const Evaluator plane(one, Domain::unit_cube(2));
    auto make = [&](const Adaptive& settings) { return settings.estimator({plane, 0}); };
    for (int replicates : {-1, 0, 3, 4097}) EXPECT_THROW(make({.replicates = replicates}), Error);
    for (double share : {-0.1, 0.0, 1.0, std::nan("")}) {
        EXPECT_THROW(make({.uniform_share = share}), Error);
        EXPECT_THROW(make({.training_share = share}), Error);
    }
    EXPECT_NO_THROW(make({.replicates = 4, .uniform_share = 0.9, .training_share = 0.9}));
    const Evaluator most(one, Domain::unit_cube(1024)), too_many(one, Domain::unit_cube(1025));
    EXPECT_NO_THROW(Adaptive{}.estimator({most, 0}));
    EXPECT_THROW(Adaptive{}.estimator({too_many, 0}), Error);
}

TEST(Adaptive, SettingsAreUsed) {
    const KnownIntegral problem = discontinuous();
    auto run = [&](const Adaptive& settings) {
        return integrate(problem.f, problem.domain, settings, {.evaluations = 30'000}, {.threads = 1});
    };
    const IntegrationResult base = run({}), replicates = run({.replicates = 32}),
                            share = run({.uniform_share = 0.5});
    EXPECT_NE(replicates.value[0], base.value[0]);
    EXPECT_GT(share.standard_error[0], base.standard_error[0]); // half of the points are wasted
    const Budget target{.relative_error = 1e-4, .evaluations = 1'000'000};
    const IntegrationResult little = integrate(problem.f, problem.domain, Adaptive{.training_share = 0.02},
                                               target, {.threads = 1}),
                            much = integrate(problem.f, problem.domain, Adaptive{.training_share = 0.9},
                                             target, {.threads = 1});
    EXPECT_NE(little.evaluations, much.evaluations);
}

} // namespace
} // namespace montelux
