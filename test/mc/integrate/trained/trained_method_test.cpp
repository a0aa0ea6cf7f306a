#include "test/mc/integrate/estimator_checks.h"
#include "test/mc/integrate/trained/trained_problems.h"
#include <gtest/gtest.h>

#include "montelux/mc/integrate/trained/trained_method.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// Another integrand than the one of the training: the second bell is as large as the first.
KnownIntegral other() {
    auto f = [](std::span<const double> x) {
        return CutBells::value(x) + bell(x[0], 2, 0.1) * bell(x[1], 1.2, 0.3) * 2 / 3;
    };
    const double truth = CutBells::integral(-1, 3, 0, 2) + bell_integral(0, 2, 1.2, 0.3) * 2 / 3;
    return {f, CutBells::domain(), {truth}};
}

TEST(Trained, UnbiasedAndCalibratedOnAnotherIntegrand) {
    expect_unbiased_and_calibrated(other(), Trained{cut_bells()}, {.evaluations = 8192}, 300, 15);
}

TEST(Trained, MixturesAndMapsKeepTheirPromises) {
    auto peak = [](std::span<const double> x) { return bell(x[0], 0.5, 0.15) * bell(x[1], 0.4, 0.15); };
    for (const Method& method : {Method(Adaptive{}), Method(Vegas{})})
        expect_keeps_promises(Trained{trained(peak, Domain::unit_cube(2), method, 40000)}, 20000);
}

TEST(Trained, NeedsFewerEvaluationsThanTrainingAgain) {
    const KnownIntegral problem = other();
    const Budget budget{.relative_error = 2e-3};
    const auto fresh = integrate(problem.f, problem.domain, Adaptive{}, budget);
    const auto again = integrate(problem.f, problem.domain, Trained{cut_bells()}, budget);
    EXPECT_TRUE(again.converged()) << again;
    EXPECT_LT(again.evaluations, fresh.evaluations);
    EXPECT_NEAR(again.value[0], problem.truth[0], 5 * again.standard_error[0]);
}

TEST(Trained, MapsStartVegas) {
    const KnownIntegral problem = other();
    const auto r =
        integrate(problem.f, problem.domain, Trained{cut_bells(Vegas{})}, {.relative_error = 2e-3});
    EXPECT_TRUE(r.converged()) << r;
    EXPECT_NEAR(r.value[0], problem.truth[0], 5 * r.standard_error[0]);
}

TEST(Trained, OtherNumbersOfVariablesAreRefused) {
    auto f = [](std::span<const double> x) { return x[0]; };
    EXPECT_THROW(integrate(f, Domain::unit_cube(3), Trained{cut_bells()}, {.evaluations = 1000}), Error);
    EXPECT_THROW(integrate(f, Domain::unit_cube(2), Trained{cut_bells(), 3}, {.evaluations = 1000}), Error);
}

} // namespace
} // namespace montelux
