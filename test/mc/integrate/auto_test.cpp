#include "test/mc/integrate/bench_integrand.h"
#include "test/mc/integrate/coverage.h"
#include "test/mc/integrate/estimator_checks.h"
#include <atomic>
#include <cctype>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "montelux/mc/integrate/adaptive/adaptive.h"
#include "montelux/mc/integrate/auto.h"
#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

KnownIntegral smooth_plane() {
    auto f = [](std::span<const double> x) { return std::exp(x[0] + 2 * x[1]); };
    return {f, Domain::unit_cube(2), {std::expm1(1.0) * std::expm1(2.0) / 2}};
}
// The part of a cube where the coordinates' sum is below one: a jump along no axis.
KnownIntegral simplex(int dimensions) {
    auto f = [](std::span<const double> x) {
        double sum = 0;
        for (double v : x) sum += v;
        return sum < 1 ? 1.0 : 0.0;
    };
    return {f, Domain::unit_cube(dimensions), {1 / std::tgamma(dimensions + 1)}};
}
KnownIntegral cut_box() {
    auto f = [](std::span<const double> x) {
        return x[0] < 0.37 && x[1] < 0.61 ? std::exp(x[0] + x[1] + x[2] + x[3] + x[4]) : 0.0;
    };
    return {f, Domain::unit_cube(5), {std::expm1(0.37) * std::expm1(0.61) * std::pow(std::expm1(1.0), 3)}};
}
// A peak of width 0.05 in a plane.
KnownIntegral peak() {
    auto f = [](std::span<const double> x) {
        const double a = x[0] - 0.43, b = x[1] - 0.61;
        return std::exp(-200 * (a * a + b * b));
    };
    return {f, Domain::unit_cube(2), {pi / 200}};
}

IntegrationResult run(const KnownIntegral& problem, const Budget& budget, std::uint64_t seed = 1) {
    return integrate(problem.f, problem.domain, Auto{}, budget, {.seed = seed, .threads = 1});
}

TEST(Auto, IsTheDefault) {
    EXPECT_EQ(Method().name(), "auto");
    const KnownIntegral problem = smooth_plane();
    EXPECT_EQ(integrate(problem.f, problem.domain).value, run(problem, {}, 0).value);
}

TEST(Auto, CubatureForSmoothIntegrandsInFewDimensions) {
    for (double error : {1e-4, 1e-8}) {
        const KnownIntegral problem = smooth_plane();
        const IntegrationResult r = run(problem, {.relative_error = error});
        EXPECT_EQ(r.method, "cubature");
        EXPECT_EQ(r.reason, "cubature converges");
        EXPECT_TRUE(r.converged());
        EXPECT_FALSE(r.statistical);
        EXPECT_LT(r.evaluations, 5000u);
        EXPECT_LT(std::abs(r.value[0] - problem.truth[0]), error * problem.truth[0]);
    }
}

TEST(Auto, CubatureOnALine) {
    const IntegrationResult smooth = integrate(
        [](double x) { return std::sin(x); }, Domain::interval(0, pi / 2), Auto{}, {.relative_error = 1e-10});
    EXPECT_EQ(smooth.method, "cubature");
    EXPECT_TRUE(smooth.converged());
    EXPECT_LT(smooth.evaluations, 1000u);
    EXPECT_NEAR(smooth.value[0], 1, 1e-10);
    // Even with a jump, which bisection closes in on.
    const IntegrationResult jump = integrate([](double x) { return x < 0.3 ? std::exp(x) : 0.0; },
                                             Domain::interval(0, 1), Auto{}, {.relative_error = 1e-6});
    EXPECT_TRUE(jump.converged());
    EXPECT_LT(std::abs(jump.value[0] - std::expm1(0.3)), 3e-6 * std::expm1(0.3));
}

TEST(Auto, SamplingForJumpsInFiveDimensions) {
    for (const KnownIntegral& problem : {cut_box(), simplex(5)}) {
        const IntegrationResult r = run(problem, {.relative_error = 1e-3, .evaluations = 2'000'000});
        EXPECT_EQ(r.method, "adaptive");
        EXPECT_TRUE(r.statistical);
        EXPECT_LE(r.standard_error[0], 1e-3 * r.value[0]);
        EXPECT_LT(std::abs(r.value[0] - problem.truth[0]), 5 * r.standard_error[0]);
        // Words, with the numbers that decided.
        EXPECT_NE(r.reason.find("cubature"), std::string::npos) << r.reason;
        EXPECT_GT(r.reason.size(), 20u);
    }
}

TEST(Auto, SamplingAboveEightDimensionsAndPlainMonteCarloAboveAThousand) {
    auto mean = [](std::span<const double> x) {
        double sum = 0;
        for (double v : x) sum += v;
        return sum / static_cast<double>(x.size());
    };
    for (int dimensions : {9, 1024, 1025, 2000}) {
        const IntegrationResult r =
            integrate(mean, Domain::unit_cube(dimensions), Auto{},
                      {.evaluations = dimensions > 100 ? 4096u : 20'000u}, {.threads = 1});
        EXPECT_EQ(r.method, dimensions > 1024 ? "basic" : "adaptive") << dimensions;
        EXPECT_EQ(r.reason.find(std::to_string(dimensions) + " dimensions"), 0u) << r.reason;
        EXPECT_TRUE(r.statistical);
        if (dimensions <= 100) {
            EXPECT_LT(std::abs(r.value[0] - 0.5), 5 * r.standard_error[0] + 1e-12);
        }
    }
}

// Cubature alone would be content with what it saw.
TEST(Auto, WarningsOfCubatureLeadToSampling) {
    // Zero at all points of the first regions: a narrow peak off the centre.
    auto f = [](std::span<const double> x) {
        double squares = 0;
        for (double v : x) squares += (v - 0.83) * (v - 0.83);
        return squares < 0.01 ? 1.0 : 0.0; // a ball of radius 0.1 in three dimensions
    };
    const double truth = 4 * pi / 3 * 1e-3;
    for (double target : {1e-2, 0.0}) {
        const IntegrationResult r =
            integrate(f, Domain::unit_cube(3), Auto{}, {.relative_error = target, .evaluations = 1'000'000},
                      {.threads = 1});
        EXPECT_EQ(r.method, "adaptive") << r.value[0];
        EXPECT_LT(std::abs(r.value[0] - truth), 0.05 * truth);
    }
}

TEST(Auto, EitherWayWithoutATarget) {
    const IntegrationResult smooth = run(smooth_plane(), {.evaluations = 20'000});
    EXPECT_LE(smooth.evaluations, 20'000u);
    EXPECT_LT(std::abs(smooth.value[0] - smooth_plane().truth[0]), 1e-6);
    const IntegrationResult jump = run(simplex(5), {.evaluations = 100'000});
    EXPECT_EQ(jump.method, "adaptive");
    EXPECT_LT(std::abs(jump.value[0] - simplex(5).truth[0]), 5 * jump.standard_error[0]);
}

TEST(Auto, NeverExceedsItsBudget) {
    for (const KnownIntegral& problem : {smooth_plane(), cut_box(), peak()})
        for (std::uint64_t evaluations : {1u, 15u, 16u, 100u, 5000u, 20'000u}) {
            std::atomic<std::uint64_t> counted = 0;
            const Integrand f = problem.f.with_function([&](const PointBatch& x, ValueBatch y) {
                counted += x.count();
                problem.f(x, y);
            });
            try {
                const IntegrationResult r =
                    integrate(f, problem.domain, Auto{}, {.evaluations = evaluations}, {.threads = 1});
                EXPECT_EQ(r.evaluations, counted);
                EXPECT_TRUE(std::isfinite(r.value[0]));
            } catch (const Error&) { // the first step does not fit
                EXPECT_LE(evaluations, 100u);
            }
            EXPECT_LE(counted, evaluations);
        }
}

TEST(Auto, SmallBudgetsOfAGaussianInEightVariables) {
    auto f = [](std::span<const double> x) {
        double squares = 0;
        for (double v : x) squares += (v - 0.4) * (v - 0.4);
        return std::exp(-squares / (2 * 0.15 * 0.15));
    };
    const double side = 0.15 * std::sqrt(pi / 2) *
                        (std::erf(0.4 / (0.15 * std::sqrt(2.0))) + std::erf(0.6 / (0.15 * std::sqrt(2.0))));
    const double exact = std::pow(side, 8);
    // Root mean squares of 20 seeds.
    for (auto [evaluations, most] :
         {std::pair{1000u, 0.6}, std::pair{2000u, 0.15}, std::pair{10'000u, 0.05}}) {
        double squares = 0;
        for (std::uint64_t seed = 1; seed <= 20; ++seed) {
            const IntegrationResult r =
                integrate(f, Domain::unit_cube(8), Auto{}, {.evaluations = evaluations}, {.seed = seed});
            EXPECT_LE(r.evaluations, evaluations);
            squares += std::pow(r.value[0] / exact - 1, 2);
        }
        EXPECT_LT(std::sqrt(squares / 20), most) << evaluations << " evaluations";
    }
}

// Root mean squares of true relative errors of 40 integrands.
double rms_of_few(Family family, const Method& method, std::uint64_t evaluations) {
    double squares = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const BenchIntegrand f({family, 8}, seed);
        const IntegrationResult r =
            integrate(as_integrand(f), domain_of(f), method, {.evaluations = evaluations}, {.seed = seed});
        EXPECT_LE(r.evaluations, evaluations);
        squares += std::pow(r.value[0] / f.exact() - 1, 2);
    }
    return std::sqrt(squares / 40);
}

// Rules do badly on kinks: cubature is given up after its first region. With half of the evaluations for
// training the density is fitted three times, not twice.
TEST(Auto, SmallBudgetsOfKinksAndProductPeaks) {
    EXPECT_LT(rms_of_few(Family::continuous, Auto{}, 5000), 0.004);
    EXPECT_LT(rms_of_few(Family::product_peak, Adaptive{}, 10'000), 0.001);
}

// Cubature is not given up where what is left would not pay for a result of sampling.
TEST(Auto, AlwaysHasAnErrorWhereAnythingWasSeen) {
    const BenchIntegrand f({Family::corner_peak, 8}, 16);
    for (std::uint64_t evaluations : {1000u, 5000u, 20'000u, 50'000u}) {
        const IntegrationResult r =
            integrate(as_integrand(f), domain_of(f), Auto{}, {.evaluations = evaluations}, {.seed = 116});
        EXPECT_LT(r.standard_error[0], f.exact()) << evaluations << " evaluations";
        EXPECT_LT(std::abs(r.value[0] - f.exact()), 5 * r.standard_error[0]) << evaluations << " evaluations";
    }
}

TEST(Auto, ZeroIntegrandGivesAWarning) {
    for (int dimensions : {1, 2, 5}) {
        auto zero = [](std::span<const double>) { return 0.0; };
        const IntegrationResult r =
            integrate(zero, Domain::unit_cube(dimensions), Auto{},
                      {.relative_error = 1e-3, .evaluations = 50'000}, {.threads = 1});
        EXPECT_EQ(r.value[0], 0);
        EXPECT_FALSE(r.converged()) << dimensions;
        EXPECT_FALSE(r.warnings.empty()) << dimensions;
    }
}

TEST(Auto, MeasuresTheErrorOfAZeroAgainstTheAbsoluteValues) {
    const auto odd = [](std::span<const double> x) { return x[0] * std::exp(-x[1]); };
    const Domain domain({{-1, 1}, {0, 1}});
    const IntegrationResult r =
        integrate(odd, domain, Auto{}, {.relative_error = 1e-3, .evaluations = 1'000'000}, {.threads = 1});
    EXPECT_TRUE(r.converged()) << r;
    EXPECT_LT(r.evaluations, 10'000u);
    EXPECT_LE(std::abs(r.value[0]), 4 * r.standard_error[0]);
    EXPECT_LT(r.standard_error[0], 1e-3); // of an integral of |f| of 0.63
    ASSERT_EQ(r.notes.size(), 2u);
    EXPECT_NE(r.notes[0].find("random points checked the rules"), std::string::npos);
    EXPECT_NE(r.notes[1].find("integral of |f|"), std::string::npos);
    // An absolute error needs no such measure.
    EXPECT_TRUE(
        integrate(odd, domain, Auto{}, {.relative_error = 1e-3, .absolute_error = 1e-6}, {.threads = 1})
            .converged());
}

TEST(Auto, ValuesThatAreNotFiniteAreCounted) {
    expect_non_finite_counted(Domain::unit_cube(2), Auto{}, 20'000);
    expect_non_finite_counted(Domain::unit_cube(5), Auto{}, 20'000);
    auto nowhere = [](std::span<const double>) { return std::nan(""); };
    EXPECT_THROW(integrate(nowhere, Domain::unit_cube(2), Auto{}, {.evaluations = 20'000}), Error);
}

TEST(Auto, InfiniteRanges) {
    const double infinity = std::numeric_limits<double>::infinity();
    auto f = [](std::span<const double> x) { return std::exp(-x[0] * x[0] - 3 * x[1]); };
    const IntegrationResult r =
        integrate(f, Domain({{-infinity, infinity}, {0, infinity}}), Auto{}, {.relative_error = 1e-5});
    EXPECT_TRUE(r.converged());
    EXPECT_LT(std::abs(r.value[0] - std::sqrt(pi) / 3), 3e-5 * r.value[0]);
}

TEST(Auto, ComponentsOfVeryDifferentSizeEachReachTheirError) {
    const Integrand f = Integrand::vector_valued(2, [](std::span<const double> x, std::span<double> y) {
        y[0] = 1e9 * std::exp(-x[0] - x[1]);
        y[1] = 1e-9 * x[0] * x[1] * x[1];
    });
    const IntegrationResult r = integrate(f, Domain::unit_cube(2), Auto{}, {.relative_error = 1e-6});
    EXPECT_TRUE(r.converged());
    EXPECT_NEAR(r.value[0] / (1e9 * std::pow(std::expm1(-1.0), 2)), 1, 3e-6);
    EXPECT_NEAR(r.value[1] / (1e-9 / 6), 1, 3e-6);
}

TEST(Auto, SameBitsForAnyThreads) {
    for (const KnownIntegral& problem : {smooth_plane(), cut_box(), peak(), two_components()})
        expect_same_bits_for_any_threads(problem, Auto{}, 30'000);
}

// On both sides of the change from cubature to sampling.
TEST(Auto, ResumesWithTheSameBits) {
    for (const KnownIntegral& problem : {smooth_plane(), simplex(5), peak()}) {
        const Evaluator evaluator(problem.f, problem.domain);
        auto words_of = [](const Estimator& e) {
            StateWriter state;
            e.save(state);
            return std::vector<std::uint64_t>(state.words().begin(), state.words().end());
        };
        auto step = [](Estimator& e, const CancelFlag* cancel) {
            const std::uint64_t done = e.tally().evaluations;
            return done >= 60'000
                       ? StepOutcome::exhausted
                       : e.step({.max_evaluations = 60'000 - done, .relative_error = 1e-3, .cancel = cancel});
        };
        auto uninterrupted = Auto{}.estimator({evaluator, 5});
        std::set<std::string> methods;
        for (int k = 0; k < 40; ++k) {
            const std::vector<std::uint64_t> before = words_of(*uninterrupted);
            const Tally tally = uninterrupted->tally();
            if (tally.evaluations > 0) methods.insert(tally.method);
            CancelFlag cancel;
            cancel.request();
            if (step(*uninterrupted, &cancel) == StepOutcome::cancelled) {
                EXPECT_EQ(words_of(*uninterrupted), before);
            }
            auto loaded = Auto{}.estimator({evaluator, 5});
            StateReader reader(before);
            loaded->load(reader);
            EXPECT_TRUE(reader.at_end());
            expect_equal_bits(loaded->tally(), tally);
            StateReader again(before);
            uninterrupted->load(again);
            const StepOutcome outcome = step(*uninterrupted, nullptr);
            EXPECT_EQ(step(*loaded, nullptr), outcome);
            EXPECT_EQ(words_of(*loaded), words_of(*uninterrupted));
            if (outcome != StepOutcome::advanced) break;
        }
        EXPECT_TRUE(methods.count("cubature") == 1);
        if (problem.domain.dimensions() == 5) {
            EXPECT_TRUE(methods.count("adaptive") == 1);
        }
    }
}

// Around a pole samples lack what lies closer than they reach, which their error must know where rules are compared with
// it.
TEST(Auto, RulesAreNotGivenUpForWhatSamplesDoNotReach) {
    const KnownIntegral pole{
        [](std::span<const double> x) { return std::pow(x[0] * x[0] + x[1] * x[1], -0.9); },
        Domain::unit_cube(2),
        {8.0303847957109548}};
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const IntegrationResult r = run(pole, {.relative_error = 1e-2, .evaluations = 1'000'000}, seed);
        EXPECT_EQ(r.method, "cubature") << r;
        EXPECT_LT(std::abs(r.value[0] - pole.truth[0]), 3 * r.standard_error[0]) << r;
    }
}

// Where it samples; where it stays with a rule its error is a bound, and is checked as one.
TEST(AutoSlowTest, UnbiasedWithHonestErrors) {
    for (const KnownIntegral& problem : {cut_box(), simplex(4), peak(), smooth_plane()}) {
        RunningMoments values;
        int one = 0, two = 0, judged = 0;
        for (std::uint64_t seed = 0; seed < 200; ++seed) {
            const IntegrationResult r = run(problem, {.evaluations = 20'000}, seed);
            if (!r.statistical) {
                EXPECT_LE(std::abs(r.value[0] - problem.truth[0]),
                          3 * r.standard_error[0] + 1e-12 * problem.truth[0]);
                continue;
            }
            values.add(r.value[0]);
            if (!r.warnings.empty()) continue;
            const double deviation = std::abs(r.value[0] - problem.truth[0]);
            ++judged;
            one += deviation <= r.standard_error[0];
            two += deviation <= 2 * r.standard_error[0];
        }
        if (values.count() < 2) continue;
        const TestResult bias = unbiasedness_test(values, problem.truth[0]);
        EXPECT_TRUE(bias.passes(significance)) << bias.description;
        if (2 * judged > static_cast<int>(values.count())) expect_honest_errors(one, two, judged);
    }
}

} // namespace
} // namespace montelux
