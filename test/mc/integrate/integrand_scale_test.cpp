// Results do not depend on the unit of the integrand; logarithms of integrands beyond the range of doubles.
#include "test/mc/integrate/integrate_testing.h"
#include "test/temporary_folder.h"
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <string>

#include "montelux/mc/integrate/integrate_log.h"

namespace montelux {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

Integrand ball_of_height(double height) {
    return Integrand([height](std::span<const double> x) {
        double r = 0;
        for (double v : x) r += v * v;
        return r < 1 ? height * (1 + x[0]) : 0.0;
    });
}

class EveryMethod : public testing::TestWithParam<std::string> {};

// Powers of two: bits are the same but for the exponent.
TEST_P(EveryMethod, ScalesExactly) {
    const Method method = Method::named(GetParam());
    const Domain cube = Domain::unit_cube(2);
    const Budget budget{.relative_error = 0, .absolute_error = 0, .evaluations = 60000};
    const IntegrationResult one = integrate(ball_of_height(1), cube, method, budget);
    for (int exponent : {-1000, -560, 560, 1000}) {
        // The first step is repeated at the right scale; beside it the run is the same.
        const IntegrationResult other =
            integrate(ball_of_height(std::ldexp(1.0, exponent)), cube, method, budget);
        ASSERT_GT(std::abs(other.value[0]), 0) << exponent;
        EXPECT_NEAR(std::ldexp(other.value[0], -exponent), one.value[0], 5 * one.standard_error[0] + 1e-9)
            << exponent;
        if (std::isfinite(one.standard_error[0])) {
            EXPECT_GT(other.standard_error[0], 0) << exponent;
            EXPECT_LT(std::ldexp(other.standard_error[0], -exponent), 4 * one.standard_error[0] + 1e-12);
        }
    }
}

TEST_P(EveryMethod, TargetsScaleExactly) {
    if (GetParam() == "metropolis") GTEST_SKIP() << "takes no target below its burn-in";
    const Method method = Method::named(GetParam());
    const Integrand one([](std::span<const double> x) { return std::exp(x[0] * x[1]); });
    const Integrand tiny([](std::span<const double> x) { return std::ldexp(std::exp(x[0] * x[1]), -700); });
    const Budget relative{.relative_error = 1e-2, .absolute_error = 0, .evaluations = 200000};
    const IntegrationResult a = integrate(one, Domain::unit_cube(2), method, relative);
    const IntegrationResult b = integrate(tiny, Domain::unit_cube(2), method, relative);
    EXPECT_EQ(a.stop, b.stop);
    EXPECT_EQ(std::ldexp(b.value[0], 700), a.value[0]);
    EXPECT_EQ(std::ldexp(b.standard_error[0], 700), a.standard_error[0]);
    const Budget absolute{
        .relative_error = 0, .absolute_error = std::ldexp(1e-2, -700), .evaluations = 200000};
    const IntegrationResult c = integrate(tiny, Domain::unit_cube(2), method, absolute);
    if (a.stop == StopReason::error_target) {
        EXPECT_EQ(c.stop, StopReason::error_target);
        EXPECT_LE(c.standard_error[0], std::ldexp(1e-2, -700));
    }
}

INSTANTIATE_TEST_SUITE_P(Scale, EveryMethod,
                         testing::Values("auto", "adaptive", "basic", "cubature", "vegas", "vegas_sobol",
                                         "quasi", "stratified", "recursive", "metropolis", "midpoint"),
                         [](const auto& each) { return each.param; });

TEST(Scale, ComponentsHaveTheirOwn) {
    const Integrand f = Integrand::vector_valued(3, [](std::span<const double> x, std::span<double> y) {
        y[0] = x[0];
        y[1] = 1e-250 * x[0];
        y[2] = 1e250 * x[0] * x[1];
    });
    for (const char* method : {"auto", "adaptive", "basic", "vegas", "quasi"}) {
        const IntegrationResult r =
            integrate(f, Domain::unit_cube(2), Method::named(method),
                      {.relative_error = 1e-2, .absolute_error = 0, .evaluations = 500000});
        EXPECT_EQ(r.stop, StopReason::error_target) << method;
        EXPECT_NEAR(r.value[0], 0.5, 0.05) << method;
        EXPECT_NEAR(r.value[1] / 1e-250, 0.5, 0.05) << method;
        EXPECT_NEAR(r.value[2] / 1e250, 0.25, 0.03) << method;
        EXPECT_GE(r.standard_error[1] / 1e-250, 0) << method;
    }
}

TEST(Scale, TinyDomainsAreNoTinyIntegrands) {
    const Integrand f([](std::span<const double> x) { return 1 + 1e200 * x[0]; });
    const Domain box({{0, 1e-200}, {0, 1e-100}});
    const IntegrationResult r = integrate(f, box, Method::named("basic"), {.relative_error = 1e-3});
    EXPECT_EQ(r.stop, StopReason::error_target);
    EXPECT_NEAR(r.value[0] / 1e-300, 1.5, 5e-3);
}

TEST(Scale, AMovedScaleSurvivesACheckpoint) {
    const TemporaryFolder folder;
    const Integrand f = ball_of_height(1e-200);
    const Domain cube = Domain::unit_cube(3);
    const Budget half{.relative_error = 0, .absolute_error = 0, .evaluations = 50000};
    const Budget all{.relative_error = 0, .absolute_error = 0, .evaluations = 100000};
    IntegrationOptions options;
    const IntegrationResult whole = integrate(f, cube, Method::named("vegas"), all);
    options.checkpoint = (folder / "state").string();
    integrate(f, cube, Method::named("vegas"), half, options);
    options.resume = true;
    const IntegrationResult resumed = integrate(f, cube, Method::named("vegas"), all, options);
    EXPECT_NEAR(resumed.value[0] / whole.value[0], 1, 0.02);
    EXPECT_GT(resumed.evaluations, 50000U);
    EXPECT_LE(resumed.evaluations, 110000U);
}

TEST(IntegrateLog, GaussiansOfAnyHeight) {
    for (double height : {-1e6, -5000.0, 0.0, 5000.0, 1e6}) {
        for (const char* method : {"auto", "adaptive", "basic", "vegas", "quasi", "cubature"}) {
            const Integrand log_f(
                [height](std::span<const double> x) { return height - (x[0] * x[0] + x[1] * x[1]) / 2; });
            const LogIntegrationResult r = integrate_log(log_f, Domain({{-8, 8}, {-8, 8}}),
                                                         Method::named(method), {.relative_error = 1e-2});
            EXPECT_EQ(r.relative.stop, StopReason::error_target) << method;
            EXPECT_LE(r.log_error, 1e-2) << method;
            EXPECT_NEAR(r.log_value, height + std::log(2 * std::numbers::pi), 5e-2) << method << height;
        }
    }
}

TEST(IntegrateLog, MinusInfinityIsZeroAndOtherInfinitiesAreMistakes) {
    const Integrand half([](double x) { return x < 0.5 ? -unbounded : -1000.0; });
    const LogIntegrationResult r =
        integrate_log(half, Domain::interval(0, 1), Method(), {.relative_error = 1e-3});
    EXPECT_NEAR(r.log_value, -1000 + std::log(0.5), 1e-2);
    EXPECT_EQ(r.relative.non_finite, 0U);

    const Integrand pole([](double x) { return x < 0.5 ? unbounded : -1000.0; });
    EXPECT_GT(integrate_log(pole, Domain::interval(0, 1), Method::named("quasi")).relative.non_finite, 0U);

    const Integrand nothing([](double) { return -unbounded; });
    const LogIntegrationResult none = integrate_log(nothing, Domain::interval(0, 1));
    EXPECT_EQ(none.log_value, -unbounded);
    EXPECT_EQ(none.log_error, unbounded);
    EXPECT_FALSE(none.relative.warnings.empty());
}

TEST(IntegrateLog, RefusesWhatHasNoMeaning) {
    const Integrand f([](double x) { return -x; });
    EXPECT_THROW(
        integrate_log(f, Domain::interval(0, 1), Method(), {.relative_error = 0, .absolute_error = 1e-3}),
        Error);
    const Integrand two =
        Integrand::vector_valued(2, [](std::span<const double>, std::span<double> y) { y[0] = y[1] = 0; });
    EXPECT_THROW(integrate_log(two, Domain::interval(0, 1)), Error);
}

} // namespace
} // namespace montelux
