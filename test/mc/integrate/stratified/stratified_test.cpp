// A5: stratified sampling on a grid, with proportional and optimal allocation.
#include "test/mc/integrate/estimator_checks.h"
#include <gtest/gtest.h>
#include <numbers>

#include "montelux/mc/integrate/stratified/strata.h"
#include "montelux/mc/integrate/stratified/stratified.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

// Mean of the squared standard errors (unbiased for the variance), and the true spread, over seeds.
struct Spread {
    RunningMoments values, squared_errors;
    double evaluations = 0; // of a run
};
Spread spread(const Integrand& f, int dimensions, const Method& method, std::uint64_t evaluations,
              int seeds) {
    Spread s;
    for (int seed = 0; seed < seeds; ++seed) {
        const IntegrationResult r =
            integrate(f, Domain::unit_cube(dimensions), method, {.evaluations = evaluations},
                      {.seed = static_cast<std::uint64_t>(seed), .threads = 1});
        s.values.add(r.value[0]);
        s.squared_errors.add(r.standard_error[0] * r.standard_error[0]);
        s.evaluations = static_cast<double>(r.evaluations);
    }
    return s;
}

const auto smooth = [](std::span<const double> x) {
    double y = 0;
    for (double v : x) y += v;
    return std::exp(y);
};
// Independent of one another at points that are a millionth apart.
const auto noise = [](std::span<const double> x) {
    std::uint64_t key = 1;
    for (double v : x) key = hash_key(key, static_cast<std::uint64_t>(v * 1e9));
    return static_cast<double>(key >> 11) * 0x1p-53;
};
const auto corner = [](std::span<const double> x) { return x[0] < 0.1 && x[1] < 0.1 ? 100.0 : x[0]; };

TEST(Strata, CellsAreBalancedAndAllocationsKeepTheirTotals) {
    EXPECT_EQ(balanced_cells(2, 100), (std::vector<std::uint64_t>{10, 10}));
    EXPECT_EQ(balanced_cells(2, 119), (std::vector<std::uint64_t>{11, 10}));
    EXPECT_EQ(balanced_cells(3, 7), (std::vector<std::uint64_t>{2, 2, 1}));
    EXPECT_EQ(balanced_cells(1, 1), (std::vector<std::uint64_t>{1}));
    EXPECT_EQ(balanced_cells(40, 1 << 10)[9], 2u);
    EXPECT_EQ(balanced_cells(40, 1 << 10)[10], 1u);
    const std::vector<double> shares{1, 0, 3};
    EXPECT_EQ(allocate_samples(3, 46, 2, shares), (std::vector<std::uint64_t>{0, 12, 14, 46}));
    EXPECT_EQ(allocate_samples(3, 6, 2, {}), (std::vector<std::uint64_t>{0, 2, 4, 6}));
    EXPECT_EQ(allocate_samples(2, 10, 2, std::vector<double>{0, 0}), (std::vector<std::uint64_t>{0, 5, 10}));
    // The boxes fill the cube.
    const Strata grid = grid_strata({3, 4});
    double volume = 0;
    std::vector<double> lower(2), width(2);
    for (std::uint64_t k = 0; k < grid.count; ++k) {
        grid.box(k, lower, width);
        volume += width[0] * width[1];
    }
    EXPECT_NEAR(volume, 1, 1e-14);
    grid.box(10, lower, width);
    EXPECT_DOUBLE_EQ(lower[0], 1 / 3.0);
    EXPECT_DOUBLE_EQ(lower[1], 0.75);
}

TEST(Stratified, UnbiasedAndCalibrated) {
    for (Allocation a : {Allocation::proportional, Allocation::neyman}) {
        expect_unbiased_and_calibrated(two_components(), Stratified{.allocation = a}, {.evaluations = 2000},
                                       1500);
        // Several passes that stop at a target (which makes them longer where they seem to need it).
        expect_unbiased_and_calibrated({smooth, Domain::unit_cube(3), {std::pow(std::numbers::e - 1, 3)}},
                                       Stratified{.allocation = a}, {.evaluations = 5000}, 500);
    }
    expect_unbiased_and_calibrated(two_components(), Stratified{.strata = 8}, {.evaluations = 2000}, 1000);
}

TEST(Stratified, ProportionalIsNeverWorseThanBasic) {
    struct Case {
        Integrand f;
        double variance;
        bool few_hits = false; // make its variance, and raise the error that is claimed
    };
    const double e1 = std::numbers::e - 1, e2 = (std::exp(2) - 1) / 2;
    const double corner_mean = 0.5 + 1 - 0.01 * 0.05, corner_square = 1 / 3.0 + 100 - 0.1 * 1e-3 / 3;
    const Case cases[] = {{smooth, e2 * e2 - std::pow(e1, 4)},
                          {noise, 1 / 12.0},
                          {corner, corner_square - corner_mean * corner_mean, true},
                          {[](std::span<const double> x) { return x[0] + x[1] < 1 ? 1.0 : 0.0; }, 0.25}};
    for (const Case& c : cases)
        for (std::uint64_t n : {50u, 1000u}) {
            const Spread s = spread(c.f, 2, Stratified{}, n, 400);
            EXPECT_GT(s.evaluations, 0.9 * static_cast<double>(n));
            if (c.few_hits) {
                EXPECT_GT(s.squared_errors.mean() / s.values.variance(), 0.7);
                EXPECT_LT(s.squared_errors.mean() / s.values.variance(), 3);
                continue;
            }
            EXPECT_LE(s.squared_errors.mean() * s.evaluations / c.variance,
                      1 + 5 * s.squared_errors.standard_error() * s.evaluations / c.variance);
            // The claimed variance is the true one, known to sqrt(2 / 400) for normal means.
            EXPECT_NEAR(s.squared_errors.mean() / s.values.variance(), 1, 0.4);
        }
    // Noise has nothing to gain, so it is the equality.
    const Spread s = spread(noise, 2, Stratified{}, 1000, 400);
    EXPECT_NEAR(s.squared_errors.mean() * s.evaluations * 12, 1, 0.02);
}

TEST(Stratified, JitteredGridInTwoDimensionsHasSlopeMinusOne) {
    const double few = spread(smooth, 2, Stratified{}, 800, 200).squared_errors.mean();
    const double many = spread(smooth, 2, Stratified{}, 80000, 20).squared_errors.mean();
    EXPECT_NEAR(0.5 * std::log(many / few) / std::log(100.0), -1, 0.02);
    // And the spread itself.
    const double a = spread(smooth, 2, Stratified{}, 200, 1000).values.standard_deviation(),
                 b = spread(smooth, 2, Stratified{}, 3200, 1000).values.standard_deviation();
    // Each logarithm is off by 1 / sqrt(2000).
    EXPECT_NEAR(std::log(b / a) / std::log(16.0), -1, 5 * std::sqrt(2.0 / 2000) / std::log(16.0));
}

TEST(Stratified, OptimalAllocationBeatsProportionalWhereStrataDiffer) {
    const auto peak = [](std::span<const double> x) {
        return std::exp(-200 * (std::pow(x[0] - 0.3, 2) + std::pow(x[1] - 0.6, 2))) * std::cos(200 * x[0]);
    };
    const double even = spread(peak, 2, Stratified{.strata = 10}, 20000, 50).squared_errors.mean();
    const double optimal =
        spread(peak, 2, Stratified{.strata = 10, .allocation = Allocation::neyman}, 20000, 50)
            .squared_errors.mean();
    EXPECT_LT(optimal, 0.3 * even);
    // A stratum that a pilot takes for constant still gets samples, so the estimate stays unbiased.
    expect_unbiased_and_calibrated({corner, Domain::unit_cube(2), {0.5 + 1 - 0.01 * 0.05}},
                                   Stratified{.strata = 4, .allocation = Allocation::neyman, .pilot = 2},
                                   {.evaluations = 3000}, 1000);
}

TEST(Stratified, TargetsAreMetInSeveralPasses) {
    const IntegrationResult r =
        integrate(smooth, Domain::unit_cube(2), Stratified{}, {.relative_error = 2e-5});
    EXPECT_EQ(r.stop, StopReason::error_target);
    EXPECT_NEAR(r.value[0], std::pow(std::numbers::e - 1, 2), 1e-4 * r.value[0]);
    EXPECT_GT(r.degrees_of_freedom, 0);
    EXPECT_LT(r.evaluations, 200000u);
}

TEST(Stratified, KeepsPromises) {
    for (const Stratified& s :
         {Stratified{}, Stratified{.allocation = Allocation::neyman}, Stratified{.strata = 20}})
        expect_keeps_promises(s, 20000);
}

TEST(StratifiedSlowTest, PassesOfAMillionAreAveraged) {
    expect_same_bits_after_resume(two_components(), Stratified{}, 2'500'000);
}

TEST(Stratified, BudgetsThatAreTooSmallAndMistakes) {
    EXPECT_THROW(integrate(smooth, Domain::unit_cube(2), Stratified{}, {.evaluations = 1}), Error);
    EXPECT_EQ(integrate(smooth, Domain::unit_cube(2), Stratified{}, {.evaluations = 2}).evaluations, 2u);
    EXPECT_THROW(integrate(smooth, Domain::unit_cube(2), Stratified{.strata = 10}, {.evaluations = 199}),
                 Error);
    EXPECT_GT(integrate(smooth, Domain::unit_cube(1000), Stratified{}, {.evaluations = 5000}).evaluations,
              4000u);
    EXPECT_THROW(integrate(smooth, Domain::unit_cube(2), Stratified{.pilot = 1}), Error);
    EXPECT_THROW(integrate(smooth, Domain::unit_cube(9), Stratified{.strata = 10}), Error);
}

} // namespace
} // namespace montelux
