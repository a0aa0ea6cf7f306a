#include "test/mc/integrate/adaptive/uniform_points.h"
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <vector>

#include "montelux/mc/integrate/adaptive/mode_search.h"
#include "montelux/mc/stats/chi_squared.h"

namespace montelux {
namespace {

struct Search {
    std::vector<Gaussian> modes;
    std::uint64_t evaluations = 0;
};
// From uniform points, where h is known without further evaluations.
template <typename F>
Search search(const F& f, int dimensions, std::size_t points, const ModeSearch& settings,
              std::uint64_t seed = 1) {
    Search result;
    const DensityFunction h = [&](const PointBatch& x, std::span<double> values) {
        std::vector<double> point(static_cast<std::size_t>(dimensions));
        for (std::size_t i = 0; i < x.count(); ++i) {
            x.gather(i, point.data());
            for (double v : point) EXPECT_TRUE(v > 0 && v < 1);
            values[i] = f(point);
        }
        result.evaluations += x.count();
    };
    const PointBuffer x = uniform_points(points, dimensions, seed);
    std::vector<double> known(points);
    h(x, known);
    result.evaluations = 0;
    result.modes = find_modes(h, x, known, settings);
    return result;
}

// Mean of exp(-K |x - p|^2) over peaks p on the diagonal; each peak has the standard deviation 1 / sqrt(2 K).
auto diagonal_peaks(std::vector<double> peaks, double narrowness) {
    return [peaks = std::move(peaks), narrowness](const std::vector<double>& x) {
        double sum = 0;
        for (double p : peaks) {
            double squares = 0;
            for (double v : x) squares += (v - p) * (v - p);
            sum += std::exp(-narrowness * squares);
        }
        return sum;
    };
}

TEST(FindModes, FindsFourNarrowPeaksInEightDimensions) {
    const double narrowness = 200, width = 1 / std::sqrt(2 * narrowness);
    const std::vector<double> peaks{0.2, 0.4, 0.6, 0.8};
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const Search s =
            search(diagonal_peaks(peaks, narrowness), 8, 2048, {.max_evaluations = 20'000}, seed);
        EXPECT_EQ(s.modes.size(), peaks.size()) << "seed " << seed;
        for (double p : peaks) {
            const std::vector<double> centre(8, p);
            const auto near = std::ranges::count_if(s.modes, [&](const Gaussian& g) {
                return std::ranges::all_of(g.mean(), [&](double m) { return std::abs(m - p) < 0.01; });
            });
            EXPECT_EQ(near, 1) << "peak " << p << ", seed " << seed;
        }
        for (const Gaussian& g : s.modes)
            for (std::size_t d = 0; d < 8; ++d) // standard deviation of each coordinate
                EXPECT_NEAR(
                    std::sqrt(std::inner_product(g.cholesky().begin() + static_cast<int>(8 * d),
                                                 g.cholesky().begin() + static_cast<int>(8 * d + 8),
                                                 g.cholesky().begin() + static_cast<int>(8 * d), 0.0)),
                    width, 0.05 * width);
    }
}

TEST(FindModes, FindsANarrowPeakUnderAWideOne) {
    auto f = [](const std::vector<double>& x) {
        double wide = 0, narrow = 0;
        for (double v : x) {
            wide += (v - 0.3) * (v - 0.3);
            narrow += (v - 0.75) * (v - 0.75);
        }
        return std::exp(-5 * wide) + 50 * std::exp(-500 * narrow);
    };
    const Search s = search(f, 3, 2048, {.max_evaluations = 20'000});
    ASSERT_GE(s.modes.size(), 2u);
    EXPECT_TRUE(std::ranges::any_of(s.modes, [](const Gaussian& g) {
        return std::ranges::all_of(g.mean(), [](double m) { return std::abs(m - 0.75) < 0.01; });
    }));
}

// Hardly any point of the cube leads to it, but many around the wide mode do.
TEST(FindModes, SurveysFindANarrowPeakBesideAWideOne) {
    const auto f = [](const std::vector<double>& x) {
        double of_wide = 0, of_narrow = 0;
        for (double v : x) {
            of_wide += (v - 0.45) * (v - 0.45);
            of_narrow += (v - 0.52) * (v - 0.52);
        }
        return std::exp(-0.5 * of_wide / (0.015 * 0.015)) + 50 * std::exp(-0.5 * of_narrow / (0.006 * 0.006));
    };
    int without = 0, with = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const auto finds = [&](std::uint64_t survey) {
            const Search s =
                search(f, 4, 2048, {.max_evaluations = 12'000, .survey = survey, .seed = seed}, seed);
            return std::ranges::any_of(s.modes, [](const Gaussian& g) {
                return std::ranges::all_of(g.mean(), [](double m) { return std::abs(m - 0.52) < 1e-3; });
            });
        };
        without += finds(0);
        with += finds(2048);
    }
    EXPECT_LE(without, 4);
    EXPECT_GE(with, 8);
}

TEST(FindModes, GaussianHasTheCurvatureOfACorrelatedPeak) {
    const std::vector<double> covariance{0.0025, 0.0015, 0.0015, 0.0016};
    const Gaussian truth({0.4, 0.6}, cholesky_factor(covariance, 2));
    auto f = [&](const std::vector<double>& x) {
        return 1e-200 * std::exp(-0.5 * truth.squared_distance(x));
    };
    const Search s = search(f, 2, 500, {.max_evaluations = 5000});
    ASSERT_EQ(s.modes.size(), 1u);
    for (int d = 0; d < 2; ++d)
        EXPECT_NEAR(s.modes[0].mean()[d], truth.mean()[d], 0.004); // 0.1 standard deviations
    for (int k : {0, 2, 3}) EXPECT_NEAR(s.modes[0].cholesky()[k], truth.cholesky()[k], 1e-3);
}

// Half of a peak, cut off by faces: its width is that of the peak, and peaks elsewhere are found.
TEST(FindModes, KnownTopsAtFacesHaveTheirCurvature) {
    constexpr double width = 0.02;
    const auto f = [](const std::vector<double>& x) {
        double sum = 0;
        for (double top : {0.0, 0.5, 1.0}) {
            double squares = 0;
            for (double v : x) squares += (v - top) * (v - top);
            sum += std::exp(-squares / (2 * width * width));
        }
        return sum;
    };
    const std::vector<Witness> known{{{1e-15, 1e-11}, {1}, 1e-3, {1.18 * width, 1.18 * width}}};
    const Search s = search(f, 2, 2048, {.max_evaluations = 8000, .peaks = known});
    ASSERT_EQ(s.modes.size(), 3u);
    for (const Gaussian& g : s.modes)
        for (int d : {0, 1}) {
            std::vector<double> off(g.mean().begin(), g.mean().end());
            off[static_cast<std::size_t>(d)] += width;
            EXPECT_NEAR(g.squared_distance(off), 1, 0.1);
        }
}

TEST(FindModes, InventsNoneForSmoothFunctions) {
    auto linear = [](const std::vector<double>& x) { return x[0] + x[1] + x[2]; };
    auto bump = [](const std::vector<double>& x) {
        double product = 1;
        for (double v : x) product *= v * (1 - v);
        return product;
    };
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        EXPECT_LE(search(linear, 3, 2048, {.max_evaluations = 20'000}, seed).modes.size(), 1u);
        EXPECT_LE(search(bump, 3, 2048, {.max_evaluations = 20'000}, seed).modes.size(), 1u);
    }
}

TEST(FindModes, PlateausGetTheGreatestWidth) {
    auto constant = [](const std::vector<double>&) { return 3.0; };
    const Search s = search(constant, 3, 2048, {.max_evaluations = 20'000, .widest = 0.25});
    ASSERT_GE(s.modes.size(), 1u);
    for (const Gaussian& g : s.modes)
        for (std::size_t d = 0; d < 3; ++d) EXPECT_NEAR(g.cholesky()[4 * d], 0.25, 1e-12);
}

// Centres and distances in widths of the cube.
auto shells(std::vector<double> centres, double radius, double width) {
    return [=](const std::vector<double>& x) {
        double sum = 0;
        for (double centre : centres) {
            double squares = 0;
            for (std::size_t d = 0; d < x.size(); ++d) squares += std::pow(x[d] - (d == 0 ? centre : 0.5), 2);
            sum += std::exp(-std::pow((std::sqrt(squares) - radius) / width, 2) / 2);
        }
        return sum;
    };
}

// Most of what the search starts from is so far away that differences of h underflow there.
TEST(FindModes, BothShellsInTenDimensions) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const Search s =
            search(shells({0.25, 0.75}, 0.14, 0.007), 10, 65536, {.max_evaluations = 28'800}, seed);
        const auto low = std::ranges::count_if(s.modes, [](const Gaussian& g) { return g.mean()[0] < 0.5; });
        EXPECT_GE(low, 1) << "seed " << seed;
        EXPECT_LT(low, std::ssize(s.modes)) << "seed " << seed;
    }
}

TEST(FindModes, CurvedRidgesGetNoGaussianWiderThanTheyAreStraight) {
    const double radius = 0.3, width = 0.01;
    const Search s = search(shells({0.5}, radius, width), 2, 2048, {.max_evaluations = 20'000});
    ASSERT_GE(s.modes.size(), 1u);
    // Along the tangent h falls to exp(-1/2) after this distance.
    const double straight = std::sqrt(2 * radius * width);
    for (const Gaussian& g : s.modes) {
        const auto l = g.cholesky();
        const double longest = std::sqrt(l[0] * l[0] + l[2] * l[2] + l[3] * l[3]);
        EXPECT_LT(longest, 1.1 * straight);
        EXPECT_GT(longest, 0.3 * straight);
    }
}

TEST(FindModes, NothingWhereNothingWasSeen) {
    auto zero = [](const std::vector<double>&) { return 0.0; };
    const Search s = search(zero, 3, 500, {.max_evaluations = 1000});
    EXPECT_TRUE(s.modes.empty());
    EXPECT_EQ(s.evaluations, 0u);
}

TEST(FindModes, KeepsToItsEvaluationsAndModes) {
    const std::vector<double> peaks{0.2, 0.4, 0.6, 0.8};
    for (int dimensions : {1, 2, 3, 8})
        for (std::uint64_t most : {0u, 1u, 5u, 8u, 9u, 20u, 60u, 300u, 1000u, 3000u}) {
            const Search s = search(diagonal_peaks(peaks, 200), dimensions, 512, {.max_evaluations = most});
            EXPECT_LE(s.evaluations, most) << dimensions << " dimensions";
        }
    EXPECT_EQ(search(diagonal_peaks(peaks, 200), 8, 2048, {.most_modes = 2, .max_evaluations = 20'000})
                  .modes.size(),
              2u);
}

} // namespace
} // namespace montelux
