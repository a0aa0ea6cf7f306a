#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/integrate/chains/draw_summary.h"

namespace montelux {
namespace {

// Chains x_t = rho x_(t-1) + uniform, numbered ones moved by `shift`.
std::vector<double> series(int chains, int draws, double rho, double shift) {
    std::uint64_t state = 12345;
    std::vector<double> values;
    for (int c = 0; c < chains; ++c) {
        double x = 0;
        for (int t = 0; t < draws; ++t) {
            state = state * 6364136223846793005u + 1442695040888963407u;
            x = rho * x + static_cast<double>(state >> 11) * 0x1p-53 - 0.5;
            values.push_back(x + shift * c);
        }
    }
    return values;
}

// What ArviZ 0.23.4 makes of the same numbers: mean, mcse, std(ddof=1), rhat, ess, ess(method="tail").
TEST(DrawSummary, IsWhatArviZComputes) {
    struct Case {
        int chains, draws;
        double rho, shift, mean, error, deviation, r_hat, bulk, tail;
    };
    for (const Case& c :
         {Case{4, 500, 0.7, 0.0, 0.01930521453, 0.02380586588, 0.414187986, 1.014972252, 296.3150355,
               751.6561831},
          Case{4, 501, 0.7, 0.2, 0.3183481754, 0.1133198166, 0.4692945377, 1.167824814, 17.32968029,
               165.069296},
          Case{2, 100, -0.5, 0.0, -0.003640801056, 0.01565230551, 0.3357797132, 1.005720149, 460.2059991,
               221.9387948},
          Case{1, 1000, 0.95, 0.0, 0.1812490073, 0.2595539567, 1.08745657, 0, 19.60882725, 11.67970167}}) {
        const DrawSummary s =
            summarize_draws(series(c.chains, c.draws, c.rho, c.shift), static_cast<std::size_t>(c.chains));
        EXPECT_NEAR(s.mean, c.mean, 1e-9);
        EXPECT_NEAR(s.standard_error / c.error, 1, 1e-8) << c.chains;
        EXPECT_NEAR(s.standard_deviation / c.deviation, 1, 1e-8);
        EXPECT_NEAR(s.bulk_effective_size / c.bulk, 1, 1e-8) << c.chains;
        EXPECT_NEAR(s.tail_effective_size / c.tail, 1, 1e-8) << c.chains;
        if (c.chains > 1) { // ArviZ has none for one chain
            EXPECT_NEAR(s.r_hat, c.r_hat, 1e-8);
        }
    }
}

TEST(DrawSummary, WalkersThatMoveTogetherAreWorthOne) {
    const std::vector<double> one = series(4, 1000, 0.5, 0);
    std::vector<double> copies;
    for (std::size_t c = 0; c < 4; ++c)
        for (int walker = 0; walker < 6; ++walker)
            copies.insert(copies.end(), one.begin() + static_cast<std::ptrdiff_t>(1000 * c),
                          one.begin() + static_cast<std::ptrdiff_t>(1000 * (c + 1)));
    const DrawSummary single = summarize_draws(one, 4), together = summarize_draws(copies, 24, 6);
    EXPECT_NEAR(together.standard_error / single.standard_error, 1, 0.01);
    EXPECT_NEAR(together.bulk_effective_size / single.bulk_effective_size, 1, 0.02);
    // Taken for chains of their own, they would claim six times as much.
    EXPECT_GT(summarize_draws(copies, 24).bulk_effective_size, 5 * single.bulk_effective_size);
}

TEST(DrawSummary, ConstantAndShortChainsHaveNoFalsePrecision) {
    const DrawSummary constant = summarize_draws(std::vector<double>(40, 2.5), 4);
    EXPECT_EQ(constant.mean, 2.5);
    EXPECT_TRUE(std::isinf(constant.standard_error));
    EXPECT_TRUE(std::isinf(constant.r_hat));
    EXPECT_EQ(constant.bulk_effective_size, 0);
    EXPECT_EQ(constant.tail_effective_size, 0);
    const DrawSummary brief = summarize_draws(series(4, 7, 0, 0), 4);
    EXPECT_TRUE(std::isinf(brief.standard_error));
    EXPECT_TRUE(std::isinf(brief.r_hat));
    EXPECT_EQ(brief.bulk_effective_size, 0);
}

} // namespace
} // namespace montelux
