#include <cmath>
#include <gtest/gtest.h>
#include <span>
#include <vector>

#include "montelux/mc/integrate/cubature/cubature_confirmation.h"
#include "montelux/mc/integrate/cubature/cubature_totals.h"
#include "montelux/mc/integrate/cubature/cubature_verification.h"
#include "montelux/mc/integrate/evaluator.h"
#include "montelux/mc/stats/moments.h"

namespace montelux {
namespace {

// `count` strips of the square with errors that alternate between 1 and 3 parts of a hundred.
CubatureRegions strips(std::size_t count) {
    CubatureRegions regions(2, 1);
    regions.add_cube();
    regions.value(0)[0] = 1;
    while (regions.count() < count) {
        CubatureRegions halves(2, 1);
        for (std::size_t r = 0; r < regions.count(); ++r) halves.add_halves(regions, r);
        regions = std::move(halves);
    }
    for (std::size_t r = 0; r < regions.count(); ++r) {
        regions.value(r)[0] = 1;
        regions.error(r)[0] = r % 2 == 0 ? 0.01 : 0.03;
        regions.lowest(r)[0] = 0;
        regions.highest(r)[0] = r % 3 == 0 ? 2 : 1;
    }
    return regions;
}

// Halves whose sums differ from the regions by `movement` parts of their errors, in region `only` alone or in all.
double factor_of(const CubatureRegions& regions, double movement, std::size_t only, std::uint64_t seed,
                 std::size_t most, std::size_t* chosen_count = nullptr) {
    CubatureConfirmation confirmation(1);
    confirmation.require(regions);
    EXPECT_TRUE(confirmation.pending());
    const std::vector<double> scale{1.0};
    const std::vector<std::size_t> chosen = confirmation.choose(regions, scale, most, seed);
    CubatureRegions halves(2, 1);
    double claimed = 0;
    for (std::size_t r = 0; r < regions.count(); ++r) claimed += regions.error(r)[0];
    for (const std::size_t r : chosen) halves.add_halves(regions, r);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        const bool moves = only == regions.count() || only == chosen[i];
        halves.value(2 * i)[0] = 0.5 + (moves ? movement * regions.error(chosen[i])[0] : 0);
        halves.value(2 * i + 1)[0] = 0.5;
    }
    if (chosen_count != nullptr) *chosen_count = chosen.size();
    const std::vector<double> all{claimed};
    confirmation.compare(regions, chosen, halves, all);
    EXPECT_FALSE(confirmation.pending());
    return confirmation.factor(0);
}

TEST(CubatureConfirmation, HonestErrorsKeepTheirSize) {
    const CubatureRegions regions = strips(64);
    for (std::uint64_t seed = 0; seed < 20; ++seed)
        EXPECT_EQ(factor_of(regions, 0.3, regions.count(), seed, 16), 1) << seed;
}

// Twice the movement, since halves have errors as well.
TEST(CubatureConfirmation, ErrorsThatAreTooSmallGrow) {
    const CubatureRegions regions = strips(64);
    EXPECT_NEAR(factor_of(regions, 5, regions.count(), 1, 64 * 64), 10, 1e-9);
    EXPECT_NEAR(factor_of(regions, -5, regions.count(), 1, 64 * 64), 10, 1e-9);
    RunningMoments factors;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        std::size_t chosen = 0;
        factors.add(factor_of(regions, 5, regions.count(), seed, 16, &chosen));
        EXPECT_NEAR(static_cast<double>(chosen), 16, 1);
    }
    EXPECT_NEAR(factors.mean(), 10, 5 * std::sqrt(factors.variance_of_mean()));
}

// On average a single region counts as much as it moves the value, however seldom it is chosen.
TEST(CubatureConfirmation, TheMovementIsUnbiased) {
    const CubatureRegions regions = strips(64);
    double claimed = 0;
    for (std::size_t r = 0; r < regions.count(); ++r) claimed += regions.error(r)[0];
    for (const std::size_t only : {2u, 3u, 5u}) {
        RunningMoments movement; // 0 where it was not chosen; factors below 1 show as 1
        for (std::uint64_t seed = 0; seed < 4000; ++seed) {
            const double factor = factor_of(regions, 1e4, only, seed, 16);
            movement.add(factor > 1 ? factor : 0);
        }
        EXPECT_NEAR(movement.mean(), 2e4 * regions.error(only)[0] / claimed,
                    5 * std::sqrt(movement.variance_of_mean()))
            << only;
    }
}

TEST(CubatureConfirmation, IsAskedForAgainWhenThereAreManyMoreRegions) {
    CubatureConfirmation confirmation(1);
    const auto confirm = [&](const CubatureRegions& regions) {
        confirmation.require(regions);
        if (!confirmation.pending()) return false;
        const std::vector<double> scale{1.0}, claimed{1.0};
        const std::vector<std::size_t> chosen = confirmation.choose(regions, scale, 4, 1);
        CubatureRegions halves(2, 1);
        for (const std::size_t r : chosen) halves.add_halves(regions, r);
        for (std::size_t i = 0; i < halves.count(); ++i) halves.value(i)[0] = 0.5;
        confirmation.compare(regions, chosen, halves, claimed);
        return true;
    };
    EXPECT_TRUE(confirm(strips(32)));
    EXPECT_FALSE(confirm(strips(32)));
    EXPECT_TRUE(confirm(strips(64)));
}

TEST(CubatureConfirmation, TotalsGrowByTheFactor) {
    const CubatureRegions regions = strips(64);
    const Evaluator evaluator([](std::span<const double>) { return 1.0; }, Domain::unit_cube(2));
    const CubatureVerification verification({evaluator}, 0);
    const auto error_after = [&](double movement) {
        CubatureConfirmation confirmation(1);
        const std::vector<double> scale{1.0}, claimed{1.28}; // 32 regions of 0.01, and 32 of 0.03
        const std::vector<std::size_t> chosen = confirmation.choose(regions, scale, 64 * 64, 1);
        CubatureRegions halves(2, 1);
        for (const std::size_t r : chosen) halves.add_halves(regions, r);
        for (std::size_t i = 0; i < halves.count(); ++i) halves.value(i)[0] = 0.5 + 0.5 * movement / 64;
        confirmation.compare(regions, chosen, halves, claimed);
        CubatureTotals totals(1);
        totals.add_up(regions, verification, confirmation, 1000);
        return totals.error()[0];
    };
    const double honest = error_after(0);
    EXPECT_GT(honest, 0);
    EXPECT_NEAR(error_after(2.56), 4 * honest, 1e-9 * honest); // twice the claim, and halves have errors too
}

} // namespace
} // namespace montelux
