// A7: multiple importance sampling with every heuristic and with optimal weights.
#include "test/mc/integrate/estimator_checks.h"
#include <gtest/gtest.h>
#include <numbers>

#include "montelux/mc/dist/families.h"
#include "montelux/mc/integrate/techniques/importance.h"
#include "montelux/mc/integrate/techniques/multiple_importance.h"
#include "montelux/mc/integrate/techniques/semidefinite.h"
#include "montelux/mc/math/constants.h"

namespace montelux {
namespace {

const Domain unit_interval = Domain::unit_cube(1);
const Technique root =
    Technique::functions([](double u) { return u * u; }, [](double x) { return 0.5 / std::sqrt(x); });
const Technique linear = LinearDistribution(); // 2x
const Technique uniform = UniformDistribution();
const Technique end = UniformDistribution(0.9, 1); // zero over most of the domain

// None of the techniques covers it well alone.
KnownIntegral two_ends() {
    return {[](double x) { return 1 / std::sqrt(x) + (x > 0.9 ? 40 * (x - 0.9) : 0); },
            unit_interval,
            {2 + 20 * 0.01}};
}
const std::vector<WeightedTechnique> three_techniques{{root, 7}, {linear, 2}, {end, 4}};

std::vector<Method> all_weights(const std::vector<WeightedTechnique>& techniques) {
    std::vector<Method> methods{MultipleImportance{techniques, OptimalWeights{}}};
    for (MisHeuristic h : {MisHeuristic::balance(), MisHeuristic::power(2), MisHeuristic::power(0.7),
                           MisHeuristic::cutoff(0.3), MisHeuristic::maximum()})
        methods.push_back(MultipleImportance{techniques, h});
    return methods;
}

double mean_variance(const Integrand& f, const Method& m, std::uint64_t evaluations, int seeds = 6) {
    RunningMoments squares;
    for (int seed = 0; seed < seeds; ++seed) {
        const IntegrationResult r = integrate(f, unit_interval, m, {.evaluations = evaluations},
                                              {.seed = static_cast<std::uint64_t>(seed)});
        squares.add(r.standard_error[0] * r.standard_error[0]);
    }
    return squares.mean();
}

TEST(MultipleImportance, UnbiasedAndCalibratedForAllWeights) {
    for (const Method& m : all_weights(three_techniques))
        expect_unbiased_and_calibrated(two_ends(), m, {.evaluations = 1400}, 500);
    // Optimal weights learn step by step, and each step is unbiased.
    expect_unbiased_and_calibrated(two_ends(), MultipleImportance{three_techniques, OptimalWeights{}},
                                   {.evaluations = 20000}, 300);
}

TEST(MultipleImportance, OneTechniqueIsImportanceSampling) {
    const Domain quarter = Domain::interval(0, pi / 2);
    auto sine = [](double x) { return std::sin(x); };
    const Technique p = LinearDistribution(0, pi / 2);
    const IntegrationResult plain =
        integrate(sine, quarter, Importance{p, ImportancePoints::random, false}, {.evaluations = 1000});
    for (MisHeuristic h : {MisHeuristic::balance(), MisHeuristic::power(), MisHeuristic::maximum()}) {
        const IntegrationResult one =
            integrate(sine, quarter, MultipleImportance{{{p, 1}}, h, false}, {.evaluations = 1000});
        EXPECT_NEAR(one.value[0], plain.value[0], 1e-14);
        EXPECT_NEAR(one.standard_error[0], plain.standard_error[0], 1e-14);
    }
}

// F divided by each technique's own count, not by all of them: a constant integrand by techniques of one
// density is exact for any counts.
TEST(MultipleImportance, DivisorsAreTheTechniquesOwnCounts) {
    for (const Method& m : all_weights({{uniform, 1}, {uniform, 5}, {uniform, 10}})) {
        const IntegrationResult r =
            integrate([](double) { return 3.0; }, unit_interval, m, {.evaluations = 3000});
        EXPECT_NEAR(r.value[0], 3, 1e-12);
    }
}

TEST(MultipleImportance, PointsOutsideTheDomainCountAsZeros) {
    auto inside = [](double x) {
        EXPECT_TRUE(x >= 0 && x <= 1);
        return std::exp(x);
    };
    for (const Method& m : all_weights({{UniformDistribution(-1, 1), 1}, {ExponentialDistribution(1), 1}}))
        expect_unbiased_and_calibrated({inside, unit_interval, {std::numbers::e - 1}}, m,
                                       {.evaluations = 2000}, 200);
}

// Theory: no variance for integrands that are combinations of the densities, whatever the counts.
TEST(MultipleImportance, OptimalWeightsSpanTheDensities) {
    auto f = [](double x) { return 3 * 2 * x - 1 + 0.5 / std::sqrt(x); }; // 3 p1 - p2 + p3
    const std::vector<WeightedTechnique> techniques{{linear, 1}, {uniform, 3}, {root, 2}};
    const IntegrationResult r =
        integrate(f, unit_interval, MultipleImportance{techniques, OptimalWeights{}}, {.evaluations = 10000});
    EXPECT_NEAR(r.value[0], 3, 1e-10);
    EXPECT_LT(r.standard_error[0], 1e-10);
    EXPECT_GT(mean_variance(f, MultipleImportance{techniques}, 10000), 1e-6) << "the balance heuristic";
}

TEST(MultipleImportance, OptimalWeightsAreNoWorseThanBalance) {
    const Integrand integrands[] = {
        two_ends().f, [](double x) { return std::exp(-50 * (x - 0.95) * (x - 0.95)); },
        [](double x) { return 2 * x; }, [](double x) { return std::sin(40 * x); }};
    for (const Integrand& f : integrands) {
        const double balance = mean_variance(f, MultipleImportance{three_techniques}, 100000);
        const double optimal =
            mean_variance(f, MultipleImportance{three_techniques, OptimalWeights{}}, 100000);
        // The pilot takes 4 % of the samples; variances are known to about a percent.
        EXPECT_LT(optimal, 1.07 * balance);
    }
    // 2x is what one technique of three_techniques samples: much to gain.
    EXPECT_LT(mean_variance(integrands[2], MultipleImportance{three_techniques, OptimalWeights{}}, 100000),
              1e-6 * mean_variance(integrands[2], MultipleImportance{three_techniques}, 100000));
    // A useless technique harms only the balance heuristic.
    const std::vector<WeightedTechnique> idle{{UniformDistribution(0, 1), 1}, {root, 9}};
    auto bump = [](double x) { return std::exp(-3 * x) * x; };
    EXPECT_LT(mean_variance(bump, MultipleImportance{idle, OptimalWeights{}}, 100000),
              0.9 * mean_variance(bump, MultipleImportance{idle}, 100000));
}

TEST(MultipleImportance, EqualTechniquesDoNotUpsetOptimalWeights) {
    expect_unbiased_and_calibrated(two_ends(),
                                   MultipleImportance{{{root, 2}, {root, 2}, {end, 1}}, OptimalWeights{}},
                                   {.evaluations = 2000}, 200);
}

TEST(MultipleImportance, VectorValuedWithCovariance) {
    const std::vector<WeightedTechnique> cover{
        {std::vector<Distribution>{LinearDistribution(0, 1), UniformDistribution(0, 2)}, 2},
        {std::vector<Distribution>{UniformDistribution(0, 1), LinearDistribution(0, 2)}, 1},
        {std::vector<Distribution>{UniformDistribution(0, 1), ExponentialDistribution(1)}, 1}};
    for (const Method& m : all_weights(cover)) {
        expect_unbiased_and_calibrated(two_components(), m, {.evaluations = 3000}, 150);
        const IntegrationResult r =
            integrate(two_components().f, two_components().domain, m, {.evaluations = 3000});
        ASSERT_EQ(r.covariance.size(), 4u);
        EXPECT_NEAR(r.covariance[3], std::pow(r.standard_error[1], 2), 1e-15);
        EXPECT_DOUBLE_EQ(r.covariance[1], r.covariance[2]);
        expect_same_bits_for_any_threads(two_components(), m, 9000);
        expect_same_bits_after_resume(two_components(), m, 9000);
        expect_non_finite_counted(Domain::unit_cube(2), m, 9000);
    }
}

TEST(MultipleImportance, PlacesThatNoTechniqueReachesGiveAWarning) {
    for (const Method& m :
         all_weights({{UniformDistribution(0, 0.4), 1}, {UniformDistribution(0.5, 1), 1}})) {
        const IntegrationResult r =
            integrate([](double) { return 1.0; }, unit_interval, m, {.evaluations = 20000});
        ASSERT_EQ(r.warnings.size(), 1u);
        EXPECT_NE(r.warnings[0].find("density is zero at (0.4"), std::string::npos) << r.warnings[0];
        EXPECT_NEAR(r.value[0], 0.9, 0.05);
    }
    EXPECT_TRUE(
        integrate(two_ends().f, unit_interval, MultipleImportance{three_techniques}, {.evaluations = 20000})
            .warnings.empty());
}

TEST(MultipleImportance, MistakesGiveAMessage) {
    auto one = [](std::span<const double>) { return 1.0; };
    EXPECT_THROW(integrate(one, unit_interval, MultipleImportance{}), Error);
    EXPECT_THROW(integrate(one, unit_interval, MultipleImportance{{{uniform, 0}}}), Error);
    EXPECT_THROW(integrate(one, Domain::unit_cube(2), MultipleImportance{{{uniform, 1}}}), Error);
    EXPECT_THROW(integrate(one, unit_interval, MultipleImportance{{{uniform, 1}}, MisHeuristic::power(0)}),
                 Error);
    EXPECT_THROW(integrate(one, unit_interval, MultipleImportance{{{uniform, 1}}, MisHeuristic::cutoff(2)}),
                 Error);
    const Technique negative =
        Technique::functions([](double u) { return u; }, [](double x) { return 0.5 - x; });
    EXPECT_THROW(integrate(one, unit_interval, MultipleImportance{{{uniform, 1}, {negative, 1}}}), Error);
    // One that contradicts its own density.
    const Technique wrong =
        Technique::functions([](double u) { return u; }, [](double x) { return x < 0.5 ? 2.0 : 0.0; });
    EXPECT_GT(
        integrate(one, unit_interval, MultipleImportance{{{wrong, 1}, {uniform, 1}}}, {.evaluations = 1000})
            .non_finite,
        100u);
}

TEST(SolveSemidefinite, RegularAndSingularEquations) {
    // [4 2; 2 3] x = [8 7] and [2 5].
    const std::vector<double> a{4, 0, 2, 3}, b{8, 7, 2, 5};
    const std::vector<double> x = solve_semidefinite(a, b, 2);
    const double expected[] = {1.25, 1.5, -0.5, 2};
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(x[static_cast<std::size_t>(i)], expected[i], 1e-14);
    // Units do not matter, and equal unknowns share a solution.
    const std::vector<double> s{1e-20, 0, 0, 1e-10, 1, 1, 1e-10, 1, 1}, r{2e-10, 2, 2};
    const std::vector<double> y = solve_semidefinite(s, r, 1);
    EXPECT_NEAR(1e-10 * y[0] + y[1] + y[2], 2, 1e-9);
    EXPECT_EQ(solve_semidefinite(std::vector<double>{0}, std::vector<double>{1}, 1)[0], 0);
}

} // namespace
} // namespace montelux
