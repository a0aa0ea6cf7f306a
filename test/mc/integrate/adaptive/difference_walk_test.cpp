#include "test/mc/integrate/adaptive/uniform_points.h"
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/integrate/adaptive/difference_walk.h"

namespace montelux {
namespace {

constexpr int slanted_dimensions = 3;

// A Gaussian whose coordinates are correlated, well inside the cube.
double slanted(const std::vector<double>& x) {
    const double a = x[0] - 0.5, b = x[1] - 0.5, c = x[2] - 0.5;
    return std::exp(-(std::pow(a - b, 2) / (2 * 0.02 * 0.02) + std::pow(a + b, 2) / (2 * 0.2 * 0.2) +
                      c * c / (2 * 0.1 * 0.1)));
}

struct Counted {
    std::uint64_t evaluations = 0;
    DensityFunction h = [this](const PointBatch& x, std::span<double> values) {
        std::vector<double> point(slanted_dimensions);
        for (std::size_t i = 0; i < x.count(); ++i) {
            x.gather(i, point.data());
            for (double v : point) EXPECT_TRUE(v > 0 && v < 1);
            values[i] = slanted(point);
        }
        evaluations += x.count();
    };
};

WalkedPoints walk(Counted& counted, const DifferenceWalk& settings) {
    const PointBuffer x = uniform_points(4096, slanted_dimensions, 1);
    std::vector<double> h(x.count());
    counted.h(x, h);
    counted.evaluations = 0;
    return walk_by_differences(counted.h, x, h, h, settings); // uniform points: weights are h
}

TEST(DifferenceWalk, HasTheMomentsOfTheFunction) {
    Counted counted;
    const DifferenceWalk settings{.key = 7, .walkers = 64, .steps = 1000};
    const WalkedPoints walked = walk(counted, settings);
    ASSERT_EQ(walked.h.size(), 64'000u);
    EXPECT_EQ(counted.evaluations, 64'000u);
    double sum_variance = 0, difference_variance = 0, third = 0;
    for (std::size_t i = 0; i < walked.h.size(); ++i) {
        const double a = walked.x.view()(i, 0) - 0.5, b = walked.x.view()(i, 1) - 0.5,
                     c = walked.x.view()(i, 2) - 0.5;
        sum_variance += (a + b) * (a + b) / 64e3;
        difference_variance += (a - b) * (a - b) / 64e3;
        third += c * c / 64e3;
    }
    // Correlated points: some 5000 effective ones, whose variances are known to 2 %.
    EXPECT_NEAR(std::sqrt(sum_variance) / 0.2, 1, 0.1);
    EXPECT_NEAR(std::sqrt(difference_variance) / 0.02, 1, 0.1);
    EXPECT_NEAR(std::sqrt(third) / 0.1, 1, 0.1);
}

// The square root of a Gaussian has twice its variances, and its points weighted by the other root have once.
TEST(DifferenceWalk, FollowsAPowerOfTheFunction) {
    Counted counted;
    const WalkedPoints walked = walk(counted, {.key = 9, .walkers = 64, .steps = 1000, .exponent = 0.5});
    EXPECT_EQ(walked.exponent, 0.5);
    double third = 0, weighted = 0, total = 0;
    for (std::size_t i = 0; i < walked.h.size(); ++i) {
        const double c = walked.x.view()(i, 2) - 0.5, weight = std::sqrt(walked.h[i]);
        third += c * c / 64e3;
        weighted += weight * c * c;
        total += weight;
    }
    EXPECT_NEAR(std::sqrt(third / 2) / 0.1, 1, 0.1);
    EXPECT_NEAR(std::sqrt(weighted / total) / 0.1, 1, 0.1);
}

// A lattice of 16 narrow peaks that no path joins. All begin at the seven of one row and one column; differences
// of those lead to the nine others.
TEST(DifferenceWalk, JumpsBetweenLikePeaks) {
    const DensityFunction lattice = [](const PointBatch& x, std::span<double> values) {
        for (std::size_t i = 0; i < x.count(); ++i) {
            double squares = 0;
            for (int d = 0; d < 2; ++d) {
                const double t = 4 * x(i, d), off = t - std::floor(t) - 0.5;
                squares += off * off;
            }
            values[i] = std::exp(-squares / (2 * 0.02 * 0.02));
        }
    };
    const PointBuffer all = uniform_points(50'000, 2, 5);
    std::vector<double> h(all.count()), weights(all.count());
    lattice(all, h);
    // The peaks of one column and one row alone.
    for (std::size_t i = 0; i < h.size(); ++i)
        weights[i] = all.view()(i, 0) < 0.25 || all.view()(i, 1) < 0.25 ? h[i] : 0;
    const WalkedPoints walked =
        walk_by_differences(lattice, all, h, weights, {.key = 1, .walkers = 64, .steps = 40});
    int elsewhere = 0;
    for (std::size_t i = walked.h.size() - 64; i < walked.h.size(); ++i)
        elsewhere += walked.x.view()(i, 0) > 0.25 && walked.x.view()(i, 1) > 0.25;
    EXPECT_GT(elsewhere, 15); // of about 36
}

TEST(DifferenceWalk, KeepsTheFunctionAtEachPoint) {
    Counted counted;
    const WalkedPoints walked = walk(counted, {.key = 3, .walkers = 8, .steps = 50});
    std::vector<double> h(walked.h.size());
    counted.h(walked.x, h);
    EXPECT_EQ(h, walked.h);
}

TEST(DifferenceWalk, SameKeySamePoints) {
    Counted counted;
    const WalkedPoints a = walk(counted, {.key = 3, .steps = 10}), b = walk(counted, {.key = 3, .steps = 10}),
                       c = walk(counted, {.key = 4, .steps = 10});
    EXPECT_EQ(a.h, b.h);
    EXPECT_NE(a.h, c.h);
}

// All begin at one end of a thin ring and reach the other.
TEST(DifferenceWalk, FollowsARidgeThatBends) {
    const DensityFunction ring = [](const PointBatch& x, std::span<double> values) {
        for (std::size_t i = 0; i < x.count(); ++i)
            values[i] = std::exp(-std::pow((std::hypot(x(i, 0) - 0.5, x(i, 1) - 0.5) - 0.35) / 0.02, 2) / 2);
    };
    const PointBuffer all = uniform_points(20'000, 2, 5);
    std::vector<double> h(all.count()), weights(all.count());
    ring(all, h);
    for (std::size_t i = 0; i < h.size(); ++i) weights[i] = all.view()(i, 0) > 0.5 ? h[i] : 0;
    const DifferenceWalk settings{.key = 1, .walkers = 64, .steps = 200};
    const WalkedPoints walked = walk_by_differences(ring, all, h, weights, settings);
    int left = 0;
    for (std::size_t i = walked.h.size() - 64; i < walked.h.size(); ++i) left += walked.x.view()(i, 0) < 0.5;
    EXPECT_GT(left, 12); // of about 32
    EXPECT_LT(left, 52);
}

} // namespace
} // namespace montelux
