// A11: control variates.
#include "test/mc/integrate/estimator_checks.h"
#include <gtest/gtest.h>
#include <numbers>

#include "montelux/mc/integrate/basic_monte_carlo.h"
#include "montelux/mc/integrate/techniques/control_variate.h"

namespace montelux {
namespace {

using std::numbers::e;

const Domain unit = Domain::unit_cube(1);
const KnownIntegral exponential_over_unit{[](double x) { return std::exp(x); }, unit, {e - 1}};
const Integrand identity = [](double x) { return x; };
Integrand powers(int count) {
    return Integrand::vector_valued(count, [](std::span<const double> x, std::span<double> y) {
        double power = 1;
        for (double& v : y) v = power *= x[0];
    });
}

TEST(ControlVariate, UnbiasedAndCalibrated) {
    expect_unbiased_and_calibrated(exponential_over_unit, ControlVariate{identity, {0.5}},
                                   {.evaluations = 2000}, 2000);
    // Betas from few points, and several steps.
    expect_unbiased_and_calibrated(exponential_over_unit,
                                   ControlVariate{powers(3), {1 / 2.0, 1 / 3.0, 1 / 4.0}},
                                   {.evaluations = 400}, 1500);
    // A control that has nothing to say.
    expect_unbiased_and_calibrated(
        exponential_over_unit,
        ControlVariate{[](double x) { return std::cos(40 * std::numbers::pi * x); }, {0}},
        {.evaluations = 2000}, 500);
}

TEST(ControlVariate, VarianceFallsByTheCorrelationSquared) {
    // var e^x = (e^2 - 1) / 2 - (e - 1)^2; cov(e^x, x) = 1 - (e - 1) / 2; var x = 1/12.
    const double variance = (e * e - 1) / 2 - (e - 1) * (e - 1), covariance = 1 - (e - 1) / 2;
    const double left = variance - covariance * covariance * 12;
    const IntegrationResult r =
        integrate(exponential_over_unit.f, unit, ControlVariate{identity, {0.5}}, {.evaluations = 1 << 20});
    const double square = r.standard_error[0] * r.standard_error[0] * static_cast<double>(r.evaluations);
    EXPECT_NEAR(square / left, 1, 0.03);
    EXPECT_LT(left, variance / 50);
    // More controls explain more.
    const IntegrationResult three =
        integrate(exponential_over_unit.f, unit, ControlVariate{powers(3), {1 / 2.0, 1 / 3.0, 1 / 4.0}},
                  {.evaluations = 1 << 17});
    EXPECT_LT(three.standard_error[0], 0.03 * r.standard_error[0]);
}

TEST(ControlVariate, CombinationsOfControlsAreExact) {
    const Integrand f = Integrand::vector_valued(2, [](std::span<const double> x, std::span<double> y) {
        y[0] = 2 + x[0] - 5 * x[0] * x[0];
        y[1] = x[0] * x[0];
    });
    const IntegrationResult r =
        integrate(f, unit, ControlVariate{powers(2), {1 / 2.0, 1 / 3.0}}, {.evaluations = 10000});
    EXPECT_NEAR(r.value[0], 2 + 0.5 - 5 / 3.0, 1e-12);
    EXPECT_NEAR(r.value[1], 1 / 3.0, 1e-12);
    EXPECT_LT(r.standard_error[0], 1e-12);
    // Two controls that are one and the same.
    const Integrand twice = Integrand::vector_valued(2, [](std::span<const double> x, std::span<double> y) {
        y[0] = x[0];
        y[1] = 2 * x[0] + 1;
    });
    const IntegrationResult s = integrate([](double x) { return 3 * x; }, unit,
                                          ControlVariate{twice, {0.5, 2}}, {.evaluations = 10000});
    EXPECT_NEAR(s.value[0], 1.5, 1e-12);
}

TEST(ControlVariate, AnyDomain) {
    // e^-x cos x over [0, inf), with e^-x as control.
    auto f = [](double x) { return std::exp(-x) * std::cos(x); };
    expect_unbiased_and_calibrated({f, Domain::interval(0, INFINITY), {0.5}},
                                   ControlVariate{[](double x) { return std::exp(-x); }, {1}},
                                   {.evaluations = 4000}, 500);
}

TEST(ControlVariate, WrongIntegralsGiveWarningsAndMistakesErrors) {
    const IntegrationResult wrong =
        integrate(exponential_over_unit.f, unit, ControlVariate{identity, {0.6}}, {.evaluations = 20000});
    ASSERT_EQ(wrong.warnings.size(), 1u);
    EXPECT_NE(wrong.warnings[0].find("control 1 was given as 0.6"), std::string::npos) << wrong.warnings[0];
    EXPECT_TRUE(
        integrate(exponential_over_unit.f, unit, ControlVariate{identity, {0.5}}, {.evaluations = 20000})
            .warnings.empty());
    EXPECT_THROW(integrate(exponential_over_unit.f, unit, ControlVariate{identity, {}}), Error);
    EXPECT_THROW(integrate(exponential_over_unit.f, unit, ControlVariate{identity, {INFINITY}}), Error);
    auto one = [](std::span<const double>) { return 1.0; };
    EXPECT_THROW(integrate(one, Domain::unit_cube(2), ControlVariate{identity, {0.5}}), Error);
    EXPECT_THROW(
        integrate(exponential_over_unit.f, unit, ControlVariate{identity, {0.5}}, {.evaluations = 5}), Error);
}

TEST(ControlVariate, KeepsPromises) {
    const Integrand controls =
        Integrand::vector_valued(2, [](std::span<const double> x, std::span<double> y) {
            y[0] = x[0];
            y[1] = x[1];
        });
    const Method over_box = ControlVariate{controls, {1, 2}};
    expect_unbiased_and_calibrated(two_components(), over_box, {.evaluations = 3000}, 500);
    expect_same_bits_for_any_threads(two_components(), over_box, 30000);
    expect_same_bits_after_resume(two_components(), over_box, 30000);
    expect_non_finite_counted(Domain::unit_cube(2), ControlVariate{controls, {0.5, 0.5}}, 30000);
}

} // namespace
} // namespace montelux
