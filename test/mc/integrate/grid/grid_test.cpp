// A1: Riemann sums, midpoint and trapezoid rules on tensor grids.
#include "test/mc/integrate/estimator_checks.h"
#include <gtest/gtest.h>
#include <numbers>

#include "montelux/mc/integrate/grid/grid.h"

namespace montelux {
namespace {

using std::numbers::e;

IntegrationResult integrate_exponential(int dimensions, const Method& method,
                                        std::uint64_t evaluations = 100'000'000) {
    // prod e^(x_d), with integral (e - 1)^d.
    return integrate(Integrand::batch([](const PointBatch& x, ValueBatch y) {
                         for (std::size_t i = 0; i < x.count(); ++i) {
                             double sum = 0;
                             for (int d = 0; d < x.dimensions(); ++d) sum += x(i, d);
                             y(i) = std::exp(sum);
                         }
                     }),
                     Domain::unit_cube(dimensions), method, {.evaluations = evaluations});
}
double relative_error(int dimensions, const Method& method) {
    return integrate_exponential(dimensions, method).value[0] / std::pow(e - 1, dimensions) - 1;
}

TEST(Grid, PointsAndWeightsAreThoseOfTheRules) {
    auto f = [](double x) { return 1 + x * x; };
    auto value = [&](const Method& m) {
        const IntegrationResult r = integrate(f, Domain::interval(0, 2), m);
        EXPECT_EQ(r.stop, StopReason::finished);
        EXPECT_FALSE(r.statistical);
        EXPECT_TRUE(std::isinf(r.standard_error[0])) << "one grid knows nothing of its error";
        return r.value[0];
    };
    EXPECT_DOUBLE_EQ(value(RiemannSum{4}), 0.5 * (1 + 1.25 + 2 + 3.25));
    EXPECT_DOUBLE_EQ(value(MidpointRule{4}), 0.5 * (1.0625 + 1.5625 + 2.5625 + 4.0625));
    EXPECT_DOUBLE_EQ(value(TrapezoidRule{4}), 0.5 * (0.5 + 1.25 + 2 + 3.25 + 2.5));
    // The corner weights of the product rule.
    auto corner = [](std::span<const double> x) { return x[0] == 0 && x[1] == 1 ? 1.0 : 0.0; };
    const IntegrationResult r = integrate(corner, Domain::unit_cube(2), TrapezoidRule{3});
    EXPECT_EQ(r.evaluations, 16u);
    EXPECT_DOUBLE_EQ(r.value[0], 0.25 / 9);
}

// Error of N points in one dimension: (e - 1) / 2 / N, (e - 1) / 24 / N^2 and -(e - 1) / 12 / N^2 exactly in
// the limit.
TEST(Grid, OrdersInOneDimension) {
    for (std::uint64_t n : {64, 128, 256, 512}) {
        const double h = 1 / static_cast<double>(n);
        EXPECT_NEAR(relative_error(1, RiemannSum{n}) / (-h / 2), 1, h);
        EXPECT_NEAR(relative_error(1, MidpointRule{n}) / (-h * h / 24), 1, h);
        EXPECT_NEAR(relative_error(1, TrapezoidRule{n}) / (h * h / 12), 1, h);
    }
}

// The curse of dimensionality: n^d points give an error of n^-2 = N^(-2/d), measured between two grids.
TEST(Grid, OrderOfMidpointsIsTwoOverDimensions) {
    const std::uint64_t coarse[] = {256, 64, 32, 16, 8, 6, 4, 4}, fine[] = {512, 128, 64, 32, 12, 8, 6, 5};
    for (int d = 1; d <= 8; ++d) {
        const double few = std::pow(static_cast<double>(coarse[d - 1]), d),
                     many = std::pow(static_cast<double>(fine[d - 1]), d);
        const double slope = std::log(relative_error(d, MidpointRule{fine[d - 1]}) /
                                      relative_error(d, MidpointRule{coarse[d - 1]})) /
                             std::log(many / few);
        EXPECT_NEAR(slope / (-2.0 / d), 1, 0.02) << "in " << d << " dimensions";
    }
}

TEST(Grid, RefinementReusesPointsAndGivesTheSameValue) {
    for (int d : {1, 2, 3}) {
        for (const Method& m : {Method(RiemannSum{}), Method(TrapezoidRule{})}) {
            auto f = [](const PointBatch& x, ValueBatch y) {
                for (std::size_t i = 0; i < x.count(); ++i)
                    y(i) = std::exp(x(i, 0) * x(i, x.dimensions() - 1));
            };
            // A budget for exactly two doublings of the first grid.
            const Evaluator evaluator(Integrand::batch(f), Domain::unit_cube(d));
            auto refined = m.estimator({evaluator});
            for (int level = 0; level < 3; ++level)
                EXPECT_EQ(refined->step({.max_evaluations = 1 << 20, .relative_error = 1e-30}),
                          StepOutcome::advanced);
            const std::uint64_t cells = 4 * (d == 1 ? 32 : d == 2 ? 6 : 4);
            const bool ends = m.name() == "trapezoid";
            const Method direct = ends ? Method(TrapezoidRule{cells}) : Method(RiemannSum{cells});
            const IntegrationResult r = integrate(evaluator.integrand(), evaluator.domain(), direct);
            EXPECT_NEAR(refined->tally().value[0], r.value[0], 1e-13);
            EXPECT_EQ(refined->tally().evaluations, r.evaluations) << "each point once";
        }
    }
}

TEST(Grid, ErrorEstimateIsThatOfTheLastTwoGrids) {
    for (const Method& m : {Method(RiemannSum{}), Method(MidpointRule{}), Method(TrapezoidRule{})}) {
        for (int d : {1, 2, 4}) {
            const IntegrationResult r = integrate_exponential(d, m, 100000);
            const double truth = std::pow(e - 1, d), off = std::abs(r.value[0] - truth);
            EXPECT_GT(r.standard_error[0], 0.8 * off) << m.name() << d;
            EXPECT_LT(r.standard_error[0], 4 * off) << m.name() << d;
            EXPECT_FALSE(r.statistical);
            EXPECT_LE(r.evaluations, 100000u);
            EXPECT_GT(r.evaluations, 25000u) << "the budget is used";
        }
    }
    const IntegrationResult r =
        integrate([](double x) { return std::sin(x); }, Domain::interval(0, std::numbers::pi / 2),
                  MidpointRule{}, {.relative_error = 1e-8});
    EXPECT_EQ(r.stop, StopReason::error_target);
    EXPECT_NEAR(r.value[0], 1, 1e-8);
    EXPECT_LT(r.evaluations, 40000u);
}

// The first grid has 32 cells, at whose points the cosine is 1 or -1; on finer ones its mean is zero.
TEST(Grid, TwoGridsThatAgreeByAccidentDoNotHideTheDifferenceBefore) {
    const Evaluator wave([](double x) { return 1 + std::cos(64 * std::numbers::pi * x); },
                         Domain::unit_cube(1));
    struct Case {
        Method method;
        double gain; // by which an error falls where the cells are halved
    };
    for (const Case& c : {Case{RiemannSum{}, 2}, Case{MidpointRule{}, 4}, Case{TrapezoidRule{}, 4}}) {
        auto estimator = c.method.estimator({wave});
        auto refined = [&] {
            EXPECT_EQ(estimator->step({.max_evaluations = 1 << 20, .relative_error = 1e-30}),
                      StepOutcome::advanced);
            return estimator->tally();
        };
        EXPECT_NEAR(std::abs(refined().value[0] - 1), 1, 1e-12) << c.method.name();
        EXPECT_NEAR(refined().standard_error[0], 1 / (c.gain - 1), 1e-12) << c.method.name();
        const Tally agreed = refined(); // with the grid before
        EXPECT_NEAR(agreed.value[0], 1, 1e-12) << c.method.name();
        EXPECT_NEAR(agreed.standard_error[0], 1 / (c.gain - 1) / c.gain, 1e-12) << c.method.name();
        EXPECT_NEAR(refined().standard_error[0], 0, 1e-12) << c.method.name();
    }
}

TEST(Grid, KeepsPromises) {
    for (const Method& m : {Method(RiemannSum{}), Method(MidpointRule{}), Method(TrapezoidRule{})})
        expect_keeps_promises(m, 50000);
    // A grid that takes several steps.
    expect_same_bits_after_resume(two_components(), MidpointRule{1100}, 2'000'000);
}

TEST(Grid, BudgetsThatAreTooSmall) {
    auto one = [](std::span<const double>) { return 1.0; };
    EXPECT_THROW(integrate(one, Domain::unit_cube(2), MidpointRule{100}, {.evaluations = 9999}), Error);
    // 2^40 points do not fit, one does.
    for (int d : {40, 10000})
        EXPECT_EQ(integrate(one, Domain::unit_cube(d), MidpointRule{}, {.evaluations = 1000}).value[0], 1);
    EXPECT_THROW(integrate(one, Domain::unit_cube(40), TrapezoidRule{}, {.evaluations = 1000}), Error);
}

} // namespace
} // namespace montelux
