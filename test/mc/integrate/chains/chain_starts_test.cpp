#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "montelux/mc/integrate/chains/chain_starts.h"
#include "montelux/mc/integrate/chains/sample_chains.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

using Coordinates = std::span<const double>;

constexpr double no_end = std::numeric_limits<double>::infinity();

double falling(Coordinates x) {
    double sum = 0;
    for (double v : x) sum -= v;
    return sum;
}

TEST(ChainStarts, WalkersScatterFromACornerAsWidelyAsFromInside) {
    for (std::size_t d : {std::size_t{8}, std::size_t{40}})
        for (const auto& [range, corner] : {std::pair{Range{0, no_end}, 0.0}, std::pair{Range{0, 1}, 1.0}}) {
            const Domain domain(std::vector<Range>(d, range));
            const Integrand f(falling);
            LogDensityCalls density(f, domain.ranges());
            const std::size_t walkers = 2 * d;
            const std::vector<double> starts =
                scattered_starts(density, std::vector<double>(d, corner), domain, walkers, 3, 0);
            ASSERT_EQ(starts.size(), walkers * d);
            double squares = 0;
            for (std::size_t i = d; i < starts.size(); ++i) {
                ASSERT_TRUE(starts[i] >= range.lower && starts[i] <= range.upper && starts[i] != corner);
                squares += std::pow(starts[i] - corner, 2);
            }
            EXPECT_NEAR(std::sqrt(squares / static_cast<double>(starts.size() - d)), 0.01, 0.003) << d;
            EXPECT_NO_THROW(expect_spanning_starts(starts, d, false, 0));
            EXPECT_NO_THROW(expect_spanning_starts(starts, d, true, 0));
        }
}

TEST(ChainStarts, SupportsThinnerThanTheScatterAreFoundDownToALimit) {
    const Domain line = Domain::interval(-1, 1);
    auto scatter = [&](double half_width) {
        const Integrand spike([half_width](double x) { return std::abs(x) < half_width ? 0 : -no_end; });
        LogDensityCalls density(spike, line.ranges());
        return scattered_starts(density, {0}, line, 4, 3, 0);
    };
    EXPECT_EQ(scatter(1e-6).size(), 4u);
    EXPECT_THROW(scatter(1e-14), Error);
}

TEST(ChainStarts, ThousandsOfWalkersStartAtDifferentPoints) {
    const Domain square({{0, 1}, {0, 1}});
    const Integrand f(falling);
    LogDensityCalls density(f, square.ranges());
    std::vector<double> starts = random_starts(density, square, 1500, 3, 0), first;
    ASSERT_EQ(starts.size(), 3000u);
    for (std::size_t i = 0; i < starts.size(); i += 2) first.push_back(starts[i]);
    std::sort(first.begin(), first.end());
    EXPECT_EQ(std::unique(first.begin(), first.end()), first.end());
}

TEST(ChainStarts, WalkersInASubspaceAreRefused) {
    auto refused = [](const std::vector<double>& starts, std::size_t d, bool within_halves) {
        try {
            expect_spanning_starts(starts, d, within_halves, 5);
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("of ensemble 5 lie in a subspace"), std::string::npos)
                << error.what();
            return true;
        }
        return false;
    };
    // Constant, and a plane in space with scales far apart, moved from the origin.
    std::vector<double> constant, plane, space;
    for (int w = 0; w < 8; ++w) {
        const double a = std::sin(3.0 * w), b = std::cos(5.0 * w);
        constant.insert(constant.end(), {0.1, a});
        plane.insert(plane.end(), {1e-5 * a, 1e7 * b, 3 + a - 2 * b});
        space.insert(space.end(), {1e-5 * a, 1e7 * b, 3 + a - 2 * b + 1e-6 * w * w});
    }
    EXPECT_TRUE(refused(constant, 2, false));
    EXPECT_TRUE(refused(plane, 3, false));
    EXPECT_FALSE(refused(space, 3, false));
    EXPECT_FALSE(refused(space, 3, true));
    // Two parallel lines span the plane, but slices along differences of one half never change lines.
    const std::vector<double> lines{0, 0, 1, 1, 2, 2, 0, 1, 1, 2, 2, 3};
    EXPECT_FALSE(refused(lines, 2, false));
    EXPECT_TRUE(refused(lines, 2, true));
    // Differences whose squares are beyond the range of numbers.
    EXPECT_FALSE(refused({1e-200, 2e-200, 5e-200, -1e-200}, 1, false));
    EXPECT_FALSE(refused({1e200, 2e200, 5e200, -1e200}, 1, false));
}

TEST(ChainStarts, EnsemblesThatDoNotSpanDoNotRun) {
    for (ChainSampler sampler : {ChainSampler::ensemble, ChainSampler::slice}) {
        ChainOptions options;
        options.sampler = sampler;
        options.chains = 1;
        options.walkers = 8;
        for (int w = 0; w < 8; ++w) options.starts.push_back({0, 0.1 * w});
        EXPECT_THROW(sample_chains(falling, Domain({{-1, 1}, {-1, 1}}), options), Error);
    }
}

TEST(ChainStarts, ChainsThatNeverMoveAreWarnedOf) {
    ChainOptions options;
    options.burn_in = 0;
    options.draws = 200;
    options.starts = {{0}};
    options.names = {"x"};
    const ChainDraws draws =
        sample_chains([](double x) { return -1e18 * x * x; }, Domain::interval(-1, 1), options);
    ASSERT_EQ(draws.warnings.size(), 1u);
    EXPECT_EQ(draws.warnings[0], "the draws of 'x' are all equal: no chain moved");
}

} // namespace
} // namespace montelux
