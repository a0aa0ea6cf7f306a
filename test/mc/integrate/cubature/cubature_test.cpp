#include "test/mc/integrate/bench_integrand.h"
#include "test/temporary_folder.h"
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <vector>

#include "montelux/mc/integrate/auto.h"
#include "montelux/mc/integrate/cubature/cubature.h"
#include "montelux/mc/integrate/cubature/cubature_regions.h"
#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

IntegrationResult run(const BenchIntegrand& f, double error, std::uint64_t evaluations,
                      const IntegrationOptions& options = {.threads = 1}) {
    return integrate(as_integrand(f), domain_of(f), Cubature{},
                     {.relative_error = error, .evaluations = evaluations}, options);
}

struct Goal {
    bench::Line line;
    double error;
    std::uint64_t median; // of evaluations beside the first check, at most
};
class CubatureGoal : public testing::TestWithParam<Goal> {};

// Deterministic: these numbers are those of this algorithm, with room for other compilers' rounding.
TEST_P(CubatureGoal, IsHonestWithinTheEvaluations) {
    const Goal goal = GetParam();
    std::vector<std::uint64_t> evaluations;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const BenchIntegrand f(goal.line, seed);
        const IntegrationResult r = run(f, goal.error, 200'000);
        evaluations.push_back(r.evaluations);
        EXPECT_FALSE(r.statistical);
        if (!r.converged()) continue;
        EXPECT_LE(std::abs(r.value[0] - f.exact()), 3 * goal.error * std::abs(f.exact())) << "seed " << seed;
    }
    std::ranges::sort(evaluations);
    const std::uint64_t check = goal.line.dimensions == 1 ? 128 : 4096;
    // The first look; and where many regions are compared with it, some halvings more.
    const std::uint64_t look = goal.line.dimensions == 1 ? 24 : 200 + 50 * goal.line.dimensions;
    EXPECT_LE(evaluations[5], goal.median + goal.median / 8 + check + look);
}

INSTANTIATE_TEST_SUITE_P(
    Families, CubatureGoal,
    testing::Values(Goal{{Family::oscillatory, 2}, 1e-4, 200}, Goal{{Family::product_peak, 2}, 1e-3, 2100},
                    Goal{{Family::corner_peak, 2}, 1e-4, 200}, Goal{{Family::gaussian, 2}, 1e-3, 1200},
                    Goal{{Family::continuous, 2}, 1e-3, 3500}, Goal{{Family::discontinuous, 2}, 1e-3, 6000},
                    Goal{{Family::oscillatory, 5}, 1e-4, 1000}, Goal{{Family::product_peak, 5}, 1e-3, 16000},
                    Goal{{Family::corner_peak, 5}, 1e-4, 9400}, Goal{{Family::gaussian, 5}, 1e-3, 9800},
                    Goal{{Family::oscillatory, 8}, 1e-4, 3900}, Goal{{Family::corner_peak, 8}, 1e-3, 8400},
                    Goal{{Family::gaussian, 8}, 1e-3, 50000}, Goal{{Family::sine, 1}, 1e-4, 7},
                    Goal{{Family::exponential, 1}, 1e-4, 68}, Goal{{Family::quadratic, 1}, 1e-4, 19},
                    Goal{{Family::inverse_root, 1}, 1e-4, 1250}, Goal{{Family::jump, 1}, 1e-4, 500},
                    Goal{{Family::two_peaks, 4}, 1e-3, 130000}, Goal{{Family::ridge, 4}, 1e-3, 161000}),
    [](const auto& goal) {
        std::string name = bench::line_name(goal.param.line);
        std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
        return name;
    });

TEST(Cubature, AlmostNeverClaimsWhatItDoesNotHave) {
    int claims = 0, silent_failures = 0;
    for (const bench::Line line : bench::bench_lines())
        for (std::uint64_t seed = 101; seed <= 110; ++seed) {
            const BenchIntegrand f(line, seed);
            const IntegrationResult r = run(f, 1e-3, 50'000);
            claims += r.converged();
            silent_failures += r.converged() && std::abs(r.value[0] - f.exact()) > 3e-3 * std::abs(f.exact());
        }
    EXPECT_GE(claims, 150);
    EXPECT_LE(silent_failures, 2); // of 280 runs
}

TEST(Cubature, IsExactForPolynomialsOfItsDegree) {
    for (int n = 1; n <= 6; ++n) {
        const int power = n == 1 ? 10 : n == 2 ? 12 : n == 3 ? 10 : 6;
        auto f = [&](std::span<const double> x) {
            double sum = 0;
            for (double v : x) sum += v;
            return std::pow(2 * sum / n - 1, power);
        };
        // The first step alone, against many.
        const IntegrationResult first = integrate(f, Domain::unit_cube(n), Cubature{},
                                                  {.evaluations = n == 1  ? 7u
                                                                  : n < 4 ? 127u
                                                                          : 200u});
        const IntegrationResult fine =
            integrate(f, Domain::unit_cube(n), Cubature{}, {.relative_error = 1e-11, .evaluations = 300'000});
        EXPECT_NEAR(first.value[0], fine.value[0], 2e-10 * std::abs(fine.value[0])) << n;
    }
}

TEST(Cubature, ReachesTightTargetsOnSmoothIntegrands) {
    auto f = [](std::span<const double> x) { return std::exp(x[0] + 0.5 * x[1]) * std::cos(x[2]); };
    const double exact = (std::numbers::e - 1) * 2 * (std::exp(0.5) - 1) * std::sin(1.0);
    const IntegrationResult r =
        integrate(f, Domain::unit_cube(3), Cubature{}, {.relative_error = 1e-11, .evaluations = 1'000'000});
    EXPECT_TRUE(r.converged());
    EXPECT_NEAR(r.value[0], exact, 1e-11 * exact);
}

TEST(Cubature, SurvivesSingularitiesAtTheEnds) {
    auto root = [](double x) { return 0.5 / std::sqrt(x); };
    const IntegrationResult near_zero =
        integrate(root, Domain::interval(0, 1), Cubature{}, {.relative_error = 1e-9, .evaluations = 100'000});
    EXPECT_TRUE(near_zero.converged()) << near_zero;
    EXPECT_NEAR(near_zero.value[0], 1, 1e-9);
    auto logarithm = [](double x) { return -std::log(1 - x); };
    const IntegrationResult near_one = integrate(logarithm, Domain::interval(0, 1), Cubature{},
                                                 {.relative_error = 1e-9, .evaluations = 100'000});
    EXPECT_TRUE(near_one.converged());
    EXPECT_NEAR(near_one.value[0], 1, 1e-9);
    auto gauss = [](double x) { return std::exp(-x * x); };
    const double infinity = std::numeric_limits<double>::infinity();
    const IntegrationResult line = integrate(gauss, Domain::interval(-infinity, infinity), Cubature{},
                                             {.relative_error = 1e-9, .evaluations = 100'000});
    EXPECT_TRUE(line.converged());
    EXPECT_NEAR(line.value[0], std::sqrt(std::numbers::pi), 2e-9);
}

TEST(Cubature, ThreadsDoNotMatter) {
    const BenchIntegrand f({Family::product_peak, 5}, 3);
    const IntegrationResult one = run(f, 1e-4, 200'000), three = run(f, 1e-4, 200'000, {.threads = 3});
    EXPECT_EQ(one.value, three.value);
    EXPECT_EQ(one.standard_error, three.standard_error);
    EXPECT_EQ(one.evaluations, three.evaluations);
}

// Stopped by cancellation after some evaluations, since a limit of evaluations shapes the last step.
void expect_same_bits_when_stopped(const BenchIntegrand& f, std::uint64_t evaluations, std::uint64_t stop) {
    const TemporaryFolder folder;
    const IntegrationResult whole = run(f, 0, evaluations);
    IntegrationOptions options{.threads = 1, .checkpoint = (folder / "state").string(), .resume = true};
    CancelFlag cancel;
    options.cancel = &cancel;
    options.progress = [&](const IntegrationResult& r) {
        if (r.evaluations >= stop) cancel.request();
    };
    const IntegrationResult part = run(f, 0, evaluations, options);
    EXPECT_EQ(part.stop, StopReason::interrupted);
    EXPECT_LT(part.evaluations, whole.evaluations);
    options.cancel = nullptr;
    options.progress = nullptr;
    const IntegrationResult rest = run(f, 0, evaluations, options);
    EXPECT_EQ(rest.value, whole.value);
    EXPECT_EQ(rest.standard_error, whole.standard_error);
    EXPECT_EQ(rest.evaluations, whole.evaluations);
}
TEST(Cubature, AResumedRunEndsWithTheSameBits) {
    expect_same_bits_when_stopped(BenchIntegrand({Family::discontinuous, 2}, 4), 20'000, 7000);
}
TEST(Cubature, OneVariableResumesWithTheValuesThatItsNextRuleUsesAgain) {
    const BenchIntegrand f({Family::exponential, 1}, 4);
    ASSERT_EQ(run(f, 0, 13).evaluations, 13u);
    expect_same_bits_when_stopped(f, 13, 7);
}

// The points of the cheaper rule belong to the next one, so that the limits 7 and 13 hold what they say.
TEST(Cubature, OneVariableBeginsWithFewPoints) {
    auto evaluations = [](const BenchIntegrand& f, double error, std::uint64_t look = 24) {
        const IntegrationResult r = run(f, error, 1000);
        EXPECT_TRUE(r.converged());
        EXPECT_LE(std::abs(r.value[0] - f.exact()), error * std::abs(f.exact()));
        return r.evaluations - 128 - look; // the check and the first look
    };
    EXPECT_EQ(evaluations(BenchIntegrand({Family::quadratic, 1}, 1), 1e-10, 30), 13u);
    EXPECT_EQ(evaluations(BenchIntegrand({Family::sine, 1}, 1), 1e-4), 7u);
    EXPECT_EQ(evaluations(BenchIntegrand({Family::sine, 1}, 1), 1e-10), 13u);
    EXPECT_EQ(evaluations(BenchIntegrand({Family::exponential, 1}, 1), 1e-4, 25), 13u);
}

TEST(Cubature, NeverExceedsItsEvaluations) {
    const BenchIntegrand f({Family::discontinuous, 5}, 1);
    std::uint64_t counted = 0;
    auto counting = Integrand::batch([&](const PointBatch& x, ValueBatch y) {
        counted += x.count();
        as_integrand(f)(x, y);
    });
    const Evaluator evaluator(counting, domain_of(f));
    const auto estimator = Cubature{}.estimator({evaluator});
    EXPECT_EQ(estimator->step({.max_evaluations = 102}), StepOutcome::exhausted);
    EXPECT_EQ(counted, 0u);
    for (std::uint64_t limit : {103u, 500u, 1000u, 5000u, 5001u, 20000u}) {
        while (estimator->step({.max_evaluations = limit - counted}) == StepOutcome::advanced) {
        }
        EXPECT_LE(counted, limit);
        EXPECT_EQ(estimator->tally().evaluations, counted);
    }
}

TEST(Cubature, AllComponentsReachTheirTargets) {
    // Of very different size, and peaked at different places.
    auto f = Integrand::vector_valued(3, [](std::span<const double> x, std::span<double> y) {
        y[0] = 1e-6 * std::exp(-300 * ((x[0] - 0.2) * (x[0] - 0.2) + (x[1] - 0.7) * (x[1] - 0.7)));
        y[1] = 1e6 / (0.01 + (x[0] - 0.8) * (x[0] - 0.8));
        y[2] = 1;
    });
    const IntegrationResult r = integrate(f, Domain::unit_cube(2), Cubature{}, {.relative_error = 1e-6});
    EXPECT_TRUE(r.converged());
    auto gauss = [](double p) {
        const double k = std::sqrt(300);
        return (std::erf(k * (1 - p)) + std::erf(k * p)) * std::sqrt(std::numbers::pi) / (2 * k);
    };
    EXPECT_NEAR(r.value[0] / (1e-6 * gauss(0.2) * gauss(0.7)), 1, 1e-6);
    EXPECT_NEAR(r.value[1] / (1e7 * (std::atan(2) + std::atan(8))), 1, 1e-6);
    EXPECT_DOUBLE_EQ(r.value[2], 1);
    EXPECT_LT(r.evaluations, 32'000u);
}

TEST(Cubature, WarnsOfAnIntegrandThatSeemsZeroEverywhere) {
    auto needle = [](std::span<const double> x) {
        return std::abs(x[0] - 0.123) < 1e-4 && std::abs(x[1] - 0.456) < 1e-4 ? 1.0 : 0.0;
    };
    const IntegrationResult r = integrate(needle, Domain::unit_cube(2), Cubature{}, {.relative_error = 1e-3});
    EXPECT_FALSE(r.converged());
    ASSERT_EQ(r.warnings.size(), 1u);
    EXPECT_NE(r.warnings[0].find("was zero at each of"), std::string::npos);
}

// A ring of width 2e-5 that holds 8.8 beside 4: regions around single points of it do not lead along it.
TEST(Cubature, DoesNotClaimWithoutTheRestOfAThinRidge) {
    const auto ring = [](std::span<const double> x) {
        return std::abs(std::hypot(x[0], x[1]) - 0.7) < 1e-5 ? 1e5 : 1;
    };
    const Integrand guide([](std::span<const double> x) { return std::hypot(x[0], x[1]) - 0.7; });
    const Integrand f =
        Integrand(ring).with_guides({[=](const PointBatch& x, ValueBatch y) { guide(x, y); }});
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const IntegrationResult r =
            integrate(f, Domain({{-1, 1}, {-1, 1}}), Cubature{},
                      {.relative_error = 1e-3, .evaluations = 200'000}, {.seed = seed, .threads = 1});
        EXPECT_FALSE(r.converged()) << seed << " " << r.value[0];
    }
}

TEST(Cubature, KnowsNoErrorBeforeAnyValueWasSeen) {
    auto needle = [](std::span<const double> x) {
        return std::abs(x[0] - 0.123) < 1e-4 && std::abs(x[1] - 0.456) < 1e-4 ? 1.0 : 0.0;
    };
    const IntegrationResult r = integrate(needle, Domain::unit_cube(2), Cubature{}, {.evaluations = 1000});
    EXPECT_EQ(r.value[0], 0);
    EXPECT_EQ(r.standard_error[0], std::numeric_limits<double>::infinity());
    ASSERT_EQ(r.warnings.size(), 1u);
    EXPECT_NE(r.warnings[0].find("was zero at each of"), std::string::npos);
}

TEST(Cubature, FindsAJumpCloseBeyondAHalvingPlane) {
    // The first halves end at 1/2: what lies between that and the jump is closer to the face than any point.
    const double jump = 0.5 + 1e-3;
    auto f = [&](std::span<const double> x) { return x[0] <= jump ? 1.0 + 0.1 * x[1] : 0.0; };
    const IntegrationResult r =
        integrate(f, Domain::unit_cube(2), Cubature{}, {.relative_error = 1e-4, .evaluations = 100'000});
    EXPECT_TRUE(r.converged());
    EXPECT_NEAR(r.value[0] / (jump * 1.05), 1, 1e-4);
}

TEST(Cubature, MemoryIsBounded) {
    const BenchIntegrand f({Family::continuous, 5}, 1);
    const Evaluator evaluator(as_integrand(f), domain_of(f));
    Cubature settings;
    settings.max_memory = 100'000;
    const IntegrationResult r = integrate(as_integrand(f), domain_of(f), settings, {.relative_error = 1e-9});
    EXPECT_EQ(r.stop, StopReason::finished);
    ASSERT_FALSE(r.warnings.empty());
    EXPECT_NE(r.warnings[0].find("memory"), std::string::npos);
    settings.max_memory = 100;
    EXPECT_THROW(settings.estimator({evaluator}), Error);
}

TEST(Cubature, TooManyDimensionsAreRefusedWithASentence) {
    auto f = [](std::span<const double>) { return 1.0; };
    try {
        integrate(f, Domain::unit_cube(16), Cubature{}, {.relative_error = 1e-3});
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("at most 15"), std::string::npos);
    }
}

TEST(Cubature, NonFiniteValuesAreCounted) {
    auto f = [](double x) { return std::abs(x - 0.5) < 0.1 ? std::numeric_limits<double>::quiet_NaN() : x; };
    const IntegrationResult r =
        integrate(f, Domain::interval(0, 1), Cubature{}, {.relative_error = 1e-2, .evaluations = 5000});
    EXPECT_GE(r.non_finite, 1u);
    EXPECT_NEAR(r.first_non_finite_point.at(0), 0.5, 0.01);
}

// Points that are evaluated again beside a singularity count, and do not break the limit.
TEST(Cubature, ShiftedPointsStayWithinTheEvaluations) {
    const Integrand inner([](std::span<const double> x) { return 1 / std::sqrt(std::abs(x[0] - x[1])); });
    for (std::uint64_t limit : {65U, 100U, 195U, 200U, 1000U, 5000U, 20001U})
        for (const Method& method : {Method(Cubature{}), Method(Auto{})}) {
            std::uint64_t counted = 0;
            const Integrand f = Integrand::batch([&](const PointBatch& x, ValueBatch y) {
                counted += x.count();
                inner(x, y);
            });
            const IntegrationResult r = integrate(
                f, Domain::unit_cube(2), method,
                {.relative_error = 1e-6, .absolute_error = 0, .evaluations = limit}, {.threads = 1});
            EXPECT_LE(counted, limit) << r;
            EXPECT_EQ(r.evaluations, counted);
        }
}

// A single point that is not finite, as on a diagonal, is replaced by one nearby.
TEST(Cubature, PointsShiftOffSingularities) {
    auto one = [](double x) { return x == 0.5 ? std::numeric_limits<double>::quiet_NaN() : x; };
    const IntegrationResult r = integrate(one, Domain::interval(0, 1), Cubature{}, {.relative_error = 1e-2});
    EXPECT_TRUE(r.converged()) << r;
    EXPECT_EQ(r.non_finite, 0u);
    EXPECT_NEAR(r.value[0], 0.5, 5e-3);
    auto diagonal = [](std::span<const double> x) { return 1 / std::sqrt(std::abs(x[0] - x[1])); };
    const IntegrationResult two = integrate(diagonal, Domain::unit_cube(2), Cubature{},
                                            {.relative_error = 1e-2, .evaluations = 1'000'000});
    EXPECT_EQ(two.non_finite, 0u);
    EXPECT_NEAR(two.value[0], 8.0 / 3, 4 * two.standard_error[0]);
}

// Left out of its middle, an odd function with a pole there would cancel.
TEST(Cubature, ValuesThatAreNotFiniteAreNoConvergence) {
    for (const auto& method : {Method(Cubature{}), Method(Auto{})}) {
        const IntegrationResult one = integrate([](double x) { return 1 / x; }, Domain::interval(-1, 1),
                                                method, {.absolute_error = 1e-6, .evaluations = 30'000});
        EXPECT_NE(one.stop, StopReason::error_target) << one;
        EXPECT_GT(one.standard_error[0], 1e-3);
        const auto pole = [](std::span<const double> x) {
            const double square = x[0] * x[0] + x[1] * x[1];
            return x[0] / (square * square);
        };
        const IntegrationResult two = integrate(pole, Domain({{-1, 1}, {-1, 1}}), method,
                                                {.absolute_error = 1e-3, .evaluations = 30'000});
        EXPECT_NE(two.stop, StopReason::error_target) << two;
    }
    // Without a limit, too, it ends.
    const IntegrationResult ended =
        integrate([](double x) { return 1 / x; }, Domain::interval(-1, 1), Auto{}, {.absolute_error = 1e-6});
    EXPECT_EQ(ended.stop, StopReason::diverges) << ended;
    EXPECT_FALSE(ended.converged());
    // A gap in a smooth function is found to be one, and a part that is not finite everywhere is left out.
    const IntegrationResult gap = integrate([](double x) { return std::sin(x) / x; }, Domain::interval(-1, 1),
                                            Cubature{}, {.absolute_error = 1e-9, .evaluations = 30'000});
    EXPECT_EQ(gap.stop, StopReason::error_target);
    EXPECT_NEAR(gap.value[0], 1.892166140734366, 1e-9);
    const IntegrationResult part = integrate([](double x) { return std::sqrt(x); }, Domain::interval(-1, 1),
                                             Cubature{}, {.absolute_error = 1e-6, .evaluations = 30'000});
    EXPECT_EQ(part.stop, StopReason::error_target);
    EXPECT_NEAR(part.value[0], 2.0 / 3, 1e-6);
}

// Its values at the first 65 points are so small that their squares are zero: no reason to believe in them.
TEST(Cubature, FindsAPeakThatItSawTheFaintestTailOf) {
    constexpr double width = 0.01;
    const auto peak = [](std::span<const double> x) {
        double squares = 0;
        for (double v : x) squares += (v - 0.3) * (v - 0.3);
        return std::exp(-squares / (2 * width * width));
    };
    const IntegrationResult r = integrate(peak, Domain(std::vector<Range>(4, {0, 1})), Cubature{},
                                          {.relative_error = 1e-3, .evaluations = 200'000}, {.threads = 1});
    EXPECT_EQ(r.stop, StopReason::error_target);
    EXPECT_FALSE(r.warnings.empty()); // too narrow for a check by random points
    EXPECT_NEAR(r.value[0] / std::pow(2 * std::numbers::pi * width * width, 2), 1, 3e-3);
}

std::vector<std::uint64_t> saved_numbers(const CubatureRegions& regions) {
    StateWriter state;
    regions.save(state);
    return {state.words().begin(), state.words().end()};
}

// save() covers all numbers of a region.
TEST(CubatureRegions, ACopyHasAllNumbersOfTheRegion) {
    for (int dimensions : {1, 2}) {
        CubatureRegions one(dimensions, 2);
        one.resize(1);
        double next = 1;
        for (const auto numbers : {one.centre(0), one.half_width(0), one.value(0), one.error(0),
                                   one.face_error(0), one.lowest(0), one.highest(0)})
            for (double& v : numbers) v = next++;
        for (std::size_t c = 0; c < 2; ++c) {
            one.series(0, c) = {next + 1, next + 2, next + 3};
            for (bool upper : {false, true})
                if (dimensions == 1) one.face(0, c, upper) = {next + 4, next + 5, upper ? 1.0 : 2.0};
            next += 6;
        }
        one.marks(0) = {0, true, true, true, 1, true};
        CubatureRegions copies(dimensions, 2);
        copies.resize(2);
        for (std::size_t r = 0; r < 2; ++r) copies.copy(r, one, 0);
        CubatureRegions first = copies;
        first.resize(1);
        EXPECT_EQ(saved_numbers(first), saved_numbers(one)) << dimensions;
        first.copy(0, copies, 1);
        EXPECT_EQ(saved_numbers(first), saved_numbers(one)) << dimensions;
    }
}

TEST(Cubature, TheUnitOfTheIntegrandDoesNotMatter) {
    std::vector<std::uint64_t> evaluations;
    for (double size : {1.0, 1e-200, 1e200}) {
        const auto f = [size](std::span<const double> x) {
            return size * std::exp(-9 * x[0] * x[1] - std::abs(x[0] - 0.3));
        };
        const IntegrationResult r =
            integrate(f, Domain(std::vector<Range>(2, {0, 1})), Cubature{},
                      {.relative_error = 1e-5, .evaluations = 200'000}, {.threads = 1});
        EXPECT_TRUE(r.converged()) << size;
        evaluations.push_back(r.evaluations);
    }
    EXPECT_EQ(evaluations[1], evaluations[0]);
    EXPECT_EQ(evaluations[2], evaluations[0]);
}

} // namespace
} // namespace montelux
