#include <cmath>
#include <gtest/gtest.h>
#include <numeric>

#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/integrate/vegas/uniform_check.h"
#include "montelux/mc/integrate/vegas/vegas.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/z_test.h"

namespace montelux {
namespace {

using Point = std::span<const double>;

// prod exp(-(x_j - c)^2 k), and its integral over the unit cube.
double gaussian(Point x, double centre, double k) {
    double square = 0;
    for (double v : x) square += (v - centre) * (v - centre);
    return std::exp(-k * square);
}
double gaussian_integral(int d, double centre, double k) {
    const double one =
        0.5 * std::sqrt(pi / k) * (std::erf(std::sqrt(k) * (1 - centre)) + std::erf(std::sqrt(k) * centre));
    return std::pow(one, d);
}

Vegas sobol(Vegas settings = {}) {
    settings.points = Vegas::Points::sobol;
    return settings;
}

struct Form {
    const char* name;
    Vegas settings;
};
const std::vector<Form> forms{{"stratified", {}}, {"sobol", sobol()}};

TEST(Vegas, MeanOfManyRunsWithFewEvaluationsIsTheTruth) {
    const Integrand f = [](Point x) { return gaussian(x, 0.7, 30); };
    for (const Form& form : forms)
        for (std::uint64_t evaluations : {150, 1500}) {
            RunningMoments runs;
            for (std::uint64_t seed = 0; seed < 1000; ++seed)
                runs.add(integrate(f, Domain::unit_cube(2), form.settings, {.evaluations = evaluations},
                                   {.seed = seed, .threads = 1})
                             .value[0]);
            const TestResult test = unbiasedness_test(runs, gaussian_integral(2, 0.7, 30));
            EXPECT_TRUE(test.passes(1e-7)) << form.name << evaluations << ": " << test.description;
        }
}

// Within 1 and 2 errors of the truth in 60-80 % and 90-99 % of runs: with 200 runs of an honest normal error
// (.683, .954) this fails in less than 1 %, so the seeds are fixed.
void expect_calibrated(const Integrand& f, int dimensions, double truth, const Vegas& settings,
                       std::uint64_t evaluations, const std::string& what) {
    int within_one = 0, within_two = 0;
    constexpr int runs = 200;
    for (std::uint64_t seed = 0; seed < runs; ++seed) {
        const IntegrationResult r = integrate(f, Domain::unit_cube(dimensions), settings,
                                              {.evaluations = evaluations}, {.seed = seed, .threads = 1});
        const double z = std::abs(r.value[0] - truth) / r.standard_error[0];
        within_one += z < 1;
        within_two += z < 2;
        EXPECT_LE(r.evaluations, evaluations);
    }
    EXPECT_GE(within_one, 0.58 * runs) << what;
    EXPECT_LE(within_one, 0.80 * runs) << what;
    EXPECT_GE(within_two, 0.88 * runs) << what;
    EXPECT_LE(within_two, 0.99 * runs) << what;
}

TEST(Vegas, ErrorsAreCalibrated) {
    for (const Form& form : forms) {
        expect_calibrated([](Point x) { return gaussian(x, 0.4, 10); }, 4, gaussian_integral(4, 0.4, 10),
                          form.settings, 12000, std::string(form.name) + " gaussian");
        expect_calibrated([](Point x) { return x[0] + x[1] < 0.6 ? std::exp(3 * x[0]) : 0.0; }, 2,
                          (std::exp(1.8) - 1 - 1.8) / 9, form.settings, 12000,
                          std::string(form.name) + " jump");
    }
}

// Two hypercubes have half of the cube each; the mean of n values has the variance of a value, with n - 1 in its
// denominator, over n.
TEST(Vegas, ErrorsOfHypercubesWithFewPointsAreThoseOfTheirMeans) {
    for (int boxes : {1, 2}) {
        const std::uint64_t evaluations = boxes == 1 ? 15 : 16;
        std::vector<RunningMoments> values(static_cast<std::size_t>(boxes));
        const Integrand f = [&](double x) {
            const double y = std::exp(2 * x);
            values[static_cast<std::size_t>(x * boxes)].add(y);
            return y;
        };
        const Evaluator g(f, Domain::unit_cube(1));
        const auto estimator = Vegas{.training_iterations = 0, .uniform_share = 0}.estimator({g, 3});
        ASSERT_EQ(estimator->step({.max_evaluations = evaluations}), StepOutcome::advanced);
        double mean = 0, variance = 0;
        std::uint64_t points = 0;
        for (const RunningMoments& box : values) {
            mean += box.mean() / boxes;
            variance += box.variance() / static_cast<double>(box.count()) / (boxes * boxes);
            points += box.count();
        }
        const Tally tally = estimator->tally();
        EXPECT_EQ(points, tally.evaluations);
        EXPECT_NEAR(tally.value[0], mean, 1e-12);
        EXPECT_NEAR(tally.standard_error[0], std::sqrt(variance), 1e-12) << boxes;
    }
}

// Smooth functions of one variable: their strata have tiny errors, and the last iteration gets what others left. The
// error of the mean, to which an iteration is compared, is here that of the first iterations; the comparisons are thus
// correlated, and small p-values somewhat more frequent than they should be.
TEST(Vegas, IterationsOfOneVariableAgree) {
    const std::pair<Integrand, std::uint64_t> cases[] = {{[](double x) { return x * x; }, 20'000},
                                                         {[](double x) { return std::exp(x); }, 100'000}};
    for (const auto& [f, evaluations] : cases) {
        int warned = 0;
        for (std::uint64_t seed = 0; seed < 30; ++seed) {
            const IntegrationResult r =
                integrate(f, Domain::unit_cube(1), Vegas{}, {.evaluations = evaluations}, {.seed = seed});
            EXPECT_GT(r.p_value, 1e-6) << evaluations << ", seed " << seed << ": " << to_string(r);
            EXPECT_GT(static_cast<double>(r.evaluations), 0.97 * static_cast<double>(evaluations));
            warned += r.p_value < 1e-3;
        }
        EXPECT_LE(warned, 2) << evaluations;
    }
}

TEST(Vegas, AdaptationReducesTheErrorOfAPeakManyTimes) {
    const Integrand f = [](Point x) { return gaussian(x, 0.3, 100); };
    const double truth = gaussian_integral(5, 0.3, 100);
    for (const Form& form : forms) {
        const auto adapted =
            integrate(f, Domain::unit_cube(5), form.settings, {.evaluations = 200000}, {.seed = 3});
        const auto basic =
            integrate(f, Domain::unit_cube(5), Method::named("basic"), {.evaluations = 200000});
        EXPECT_LT(adapted.standard_error[0], 0.05 * basic.standard_error[0]) << form.name;
        EXPECT_NEAR(adapted.value[0], truth, 5 * adapted.standard_error[0]) << form.name;
        EXPECT_LT(adapted.standard_error[0], 0.01 * truth) << form.name;
        EXPECT_TRUE(adapted.warnings.empty()) << adapted;
        EXPECT_GT(adapted.degrees_of_freedom, 0);
    }
}

// Strata where the values spread get the points: the ridge that no map of single coordinates can follow.
TEST(Vegas, StratificationAdaptsToADiagonalRidge) {
    const Integrand f = [](Point x) { return std::exp(-400 * (x[0] - x[1]) * (x[0] - x[1])); };
    const Budget budget{.evaluations = 100000};
    const auto with = integrate(f, Domain::unit_cube(2), Vegas{}, budget);
    const auto without = integrate(f, Domain::unit_cube(2), Vegas{.beta = 0}, budget);
    EXPECT_LT(with.standard_error[0], 0.8 * without.standard_error[0]);
}

TEST(Vegas, VectorsHaveCovariancesAndSizesDoNotMatter) {
    // The second component is a million times the first, and so is its error; the third is their sum.
    const Integrand f = Integrand::vector_valued(3, [](Point x, std::span<double> y) {
        y[0] = gaussian(x, 0.3, 20);
        y[1] = 1e6 * gaussian(x, 0.6, 20);
        y[2] = y[0] + y[1];
    });
    const double a = gaussian_integral(3, 0.3, 20), b = 1e6 * gaussian_integral(3, 0.6, 20);
    for (const Form& form : forms) {
        const auto r = integrate(f, Domain::unit_cube(3), form.settings, {.evaluations = 100000});
        EXPECT_NEAR(r.value[0], a, 5 * r.standard_error[0]) << form.name;
        EXPECT_NEAR(r.value[1], b, 5 * r.standard_error[1]) << form.name;
        EXPECT_LT(r.standard_error[0], 0.01 * a) << form.name;
        EXPECT_LT(r.standard_error[1], 0.01 * b) << form.name;
        ASSERT_EQ(r.covariance.size(), 9u);
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(std::sqrt(r.covariance[i * 4]), r.standard_error[i], 1e-9 * r.standard_error[i]);
            for (int j = 0; j < 3; ++j) EXPECT_EQ(r.covariance[i * 3 + j], r.covariance[j * 3 + i]);
        }
        const double sum = r.covariance[0] + r.covariance[4] + 2 * r.covariance[1];
        EXPECT_NEAR(r.covariance[8] / sum, 1, 1e-6) << form.name;
        // The variances alone are the same.
        const auto diagonal = integrate(f, Domain::unit_cube(3), form.settings, {.evaluations = 100000},
                                        {.full_covariance = false});
        EXPECT_TRUE(diagonal.covariance.empty());
        EXPECT_EQ(diagonal.value, r.value);
    }
}

TEST(Vegas, BitsDoNotDependOnThreads) {
    const Integrand f = [](Point x) { return gaussian(x, 0.4, 30); };
    for (const Form& form : forms) {
        const Budget budget{.evaluations = 150000};
        const auto one = integrate(f, Domain::unit_cube(3), form.settings, budget, {.threads = 1});
        const auto five = integrate(f, Domain::unit_cube(3), form.settings, budget, {.threads = 5});
        EXPECT_EQ(one.value, five.value) << form.name;
        EXPECT_EQ(one.standard_error, five.standard_error) << form.name;
        EXPECT_EQ(one.chi_squared, five.chi_squared) << form.name;
    }
}

TEST(Vegas, SavedAndRestoredRunEndsWithTheSameBits) {
    const Evaluator g([](Point x) { return gaussian(x, 0.4, 30); }, Domain::unit_cube(3));
    for (const Form& form : forms)
        for (int broken_after : {1, 4, 7, 9}) {
            const Problem problem{g, 7};
            auto whole = form.settings.estimator(problem), first = form.settings.estimator(problem);
            const StepRequest request{.max_evaluations = 1 << 20, .relative_error = 1e-9};
            for (int k = 0; k < 11; ++k) ASSERT_EQ(whole->step(request), StepOutcome::advanced);
            for (int k = 0; k < broken_after; ++k) first->step(request);
            StateWriter written;
            first->save(written);
            StateReader reader({written.words().begin(), written.words().end()});
            auto second = form.settings.estimator(problem);
            second->load(reader);
            EXPECT_TRUE(reader.at_end());
            for (int k = broken_after; k < 11; ++k) second->step(request);
            EXPECT_EQ(whole->tally().value, second->tally().value) << form.name << broken_after;
            EXPECT_EQ(whole->tally().standard_error, second->tally().standard_error);
            EXPECT_EQ(whole->tally().evaluations, second->tally().evaluations);
            EXPECT_EQ(whole->tally().chi_squared, second->tally().chi_squared);
        }
}

TEST(Vegas, CancelledStepChangesNothing) {
    const Evaluator g([](Point x) { return x[0]; }, Domain::unit_cube(2));
    for (const Form& form : forms) {
        auto estimator = form.settings.estimator({g, 0});
        CancelFlag cancel;
        cancel.request();
        EXPECT_EQ(estimator->step({.max_evaluations = 10000, .cancel = &cancel}), StepOutcome::cancelled);
        EXPECT_EQ(estimator->tally().evaluations, 0u);
    }
}

TEST(Vegas, TrainedMapCanBeSavedAndUsedAgain) {
    const Integrand f = [](Point x) { return gaussian(x, 0.25, 200); };
    const Domain cube = Domain::unit_cube(4);
    const AdaptiveMap map = train_map(Evaluator(f, cube), 60000);
    const Budget budget{.evaluations = 10000};
    const auto fresh = integrate(f, cube, Vegas{}, budget);
    for (const Form& form : forms) {
        Vegas reuse = form.settings;
        reuse.training_iterations = 0;
        reuse.map = map;
        const auto r = integrate(f, cube, reuse, budget);
        EXPECT_LT(r.standard_error[0], 0.7 * fresh.standard_error[0]) << form.name;
        EXPECT_NEAR(r.value[0], gaussian_integral(4, 0.25, 200), 5 * r.standard_error[0]);
    }
    EXPECT_THROW(integrate(f, Domain::unit_cube(3), Vegas{.map = map}), Error);
}

// The map knows the left peak alone; the right one is wide enough for uniform points to find.
TEST(Vegas, LostPeakGivesAWarning) {
    const auto left = [](Point x) { return gaussian(x, 0.2, 400); };
    const Integrand both = [&](Point x) { return gaussian(x, 0.2, 400) + gaussian(x, 0.8, 100); };
    const AdaptiveMap map = train_map(Evaluator(left, Domain::unit_cube(4)), 200000);
    for (const Form& form : forms) {
        Vegas reuse = form.settings;
        reuse.training_iterations = 0;
        reuse.alpha = 0;
        reuse.map = map;
        const auto good = integrate(left, Domain::unit_cube(4), reuse, {.evaluations = 100000});
        EXPECT_TRUE(good.warnings.empty()) << good;
        const auto bad = integrate(both, Domain::unit_cube(4), reuse, {.evaluations = 100000});
        EXPECT_FALSE(bad.warnings.empty()) << form.name << bad;
    }
}

// x has the mean 1/2, which the check's own points find with an error of 0.003.
TEST(UniformCheck, MeansFarAboveAndFarBelowTheValueGiveAWarning) {
    const Evaluator g([](double x) { return x; }, Domain::unit_cube(1));
    MapInsight insight(1);
    insight.square = insight.uniform_square = {1.0 / 3};
    insight.size = 0.5;
    insight.largest_square = 1;
    UniformCheck check(1);
    const std::vector<double> scale{1};
    NonFiniteCount non_finite;
    ASSERT_TRUE(
        check.run({g, 7}, nullptr, AdaptiveMap(1, 16), insight, 1e5, 10'000, 5, scale, non_finite, nullptr));
    const auto warnings = [&](double value) {
        std::vector<std::string> texts;
        check.warn({value}, {0.001}, scale, texts);
        return texts;
    };
    const double mean = check.moments().mean(0);
    EXPECT_TRUE(warnings(mean).empty());
    for (double value : {mean - 0.1, mean + 0.1}) {
        const std::vector<std::string> texts = warnings(value);
        ASSERT_EQ(texts.size(), 1u) << value;
        EXPECT_NE(texts[0].find("have a mean of"), std::string::npos) << texts[0];
    }
}

TEST(Vegas, HeavyTailGivesAWarning) {
    // Infinite variance along the diagonal, where no map of single coordinates helps.
    const Integrand f = [](Point x) { return std::pow(std::abs(x[0] - x[1]) + 1e-15, -0.95); };
    const auto r = integrate(f, Domain::unit_cube(2), Vegas{}, {.evaluations = 100000});
    EXPECT_FALSE(r.warnings.empty()) << r;
}

TEST(Vegas, ConstantsAreExactAndZerosHaveNoKnownError) {
    for (const Form& form : forms) {
        const auto zero = integrate([](Point) { return 0.0; }, Domain::unit_cube(2), form.settings);
        EXPECT_EQ(zero.value[0], 0) << form.name;
        EXPECT_TRUE(std::isinf(zero.standard_error[0])) << form.name; // of what was not seen
        const auto three =
            integrate([](Point) { return 3.0; }, Domain::unit_cube(2), form.settings, {.evaluations = 50000});
        EXPECT_NEAR(three.value[0], 3, 5e-4) << form.name;
        EXPECT_TRUE(three.warnings.empty()) << three;
    }
}

TEST(Vegas, InfiniteRangesAndManyDimensions) {
    const Integrand normal = [](double x) { return std::exp(-0.5 * x * x); };
    const double unbounded = std::numeric_limits<double>::infinity();
    for (const Form& form : forms) {
        const auto r = integrate(normal, Domain::interval(-unbounded, unbounded), form.settings,
                                 {.relative_error = 1e-4});
        EXPECT_NEAR(r.value[0], std::sqrt(2 * pi), 6e-4 * std::sqrt(2 * pi)) << form.name;
        const Integrand sum = [](Point x) { return std::accumulate(x.begin(), x.end(), 0.0); };
        const auto wide = integrate(sum, Domain::unit_cube(100), form.settings, {.evaluations = 20000});
        EXPECT_NEAR(wide.value[0], 50, 5 * wide.standard_error[0]) << form.name;
    }
}

TEST(Vegas, SettingsOutOfRangeAreRefused) {
    const Evaluator g([](Point x) { return x[0]; }, Domain::unit_cube(2));
    EXPECT_THROW(Vegas{.alpha = -1}.estimator({g, 0}), Error);
    EXPECT_THROW(Vegas{.beta = 2}.estimator({g, 0}), Error);
    EXPECT_THROW(Vegas{.increments = 0}.estimator({g, 0}), Error);
    EXPECT_THROW(Vegas{.uniform_share = 1.5}.estimator({g, 0}), Error);
    EXPECT_THROW(sobol(Vegas{.replicates = 1}).estimator({g, 0}), Error);
    const Evaluator wide([](Point x) { return x[0]; }, Domain::unit_cube(2000));
    EXPECT_THROW(sobol().estimator({wide, 0}), Error);
    EXPECT_NO_THROW(Vegas{}.estimator({wide, 0}));
}

} // namespace
// A map of many variables that is fitted to few points follows noise, and the product of its densities takes
// the integral with it.
TEST(Vegas, FewPointsOfManyVariablesLeaveTheMapAlone) {
    const Integrand product([](std::span<const double> x) {
        double p = 1;
        for (double v : x) p *= 0.99 + 0.02 * v;
        return p;
    });
    for (const Form& form : forms) {
        const IntegrationResult r =
            integrate(product, Domain::unit_cube(300), form.settings, {.evaluations = 20000});
        EXPECT_LT(std::abs(r.value[0] - 1), 6 * r.standard_error[0]) << form.name;
        EXPECT_LT(r.standard_error[0], 0.01) << form.name;
    }
}

} // namespace montelux
