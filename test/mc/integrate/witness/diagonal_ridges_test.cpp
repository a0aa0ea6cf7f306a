#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/integrate/witness/diagonal_ridges.h"
#include "montelux/mc/integrate/witness/first_look.h"

namespace montelux {
namespace {

double greatest_mass(const Integrand& f, int dimensions, std::uint64_t seed) {
    double most = 0;
    for (const Witness& w : first_look(Evaluator(f, Domain::unit_cube(dimensions)), {.seed = seed}).witnesses)
        most = std::max(most, std::abs(w.value[0]) * w.volume);
    return most;
}

// Equal coordinates are a surface of poles, where the values of a diagonal are as large as doubles make them.
TEST(DiagonalRidges, HoldNoMoreThanTheIntegral) {
    const auto potential = [](std::span<const double> x) {
        return 1 / std::sqrt(std::pow(x[0] - x[3], 2) + std::pow(x[1] - x[4], 2) + std::pow(x[2] - x[5], 2) +
                             1e-30);
    };
    const auto ridge = [](std::span<const double> x) {
        return 1 + 1e6 * std::exp(-1e8 * std::pow(x[0] - x[1], 2));
    };
    int above = 0; // where another direction lies on the ridge, too, by chance
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        EXPECT_LT(greatest_mass(Integrand(potential), 6, seed), 1.88) << seed;
        above += greatest_mass(Integrand(ridge), 2, seed) > 178;
    }
    EXPECT_LE(above, 1);
}

TEST(DiagonalRidges, AreMeasuredAndPeaksAreNot) {
    const double width = 1e-5;
    const Integrand peak([=](std::span<const double> x) {
        return 1 + 1e15 * std::exp(-(std::pow(x[0] - 0.3, 2) + std::pow(x[1] - 0.6, 2)) / (width * width));
    });
    const Integrand ridge(
        [=](std::span<const double> x) { return 1 + 1e9 * std::exp(-std::pow((x[0] - x[1]) / width, 2)); });
    const Domain square = Domain::unit_cube(2);
    const std::vector<std::vector<double>> landmarks{{0.3, 0.6}};
    for (const Integrand* f : {&peak, &ridge}) {
        const Evaluator evaluator(*f, square);
        RawValues raw(evaluator);
        int measured = 0;
        for (std::uint64_t seed = 0; seed < 10; ++seed) {
            std::vector<LadderPath> paths = LadderPaths(square, 2, landmarks, {}, seed).joint();
            std::vector<std::vector<double>> points;
            std::vector<double> volumes;
            for (const LadderPath& path : paths)
                for (std::size_t shell = 0; shell < ladder.size(); ++shell) {
                    points.push_back(path.at(path.exponent(shell)));
                    volumes.push_back(path.volume(path.exponent(shell), {1, 1}));
                }
            measure_diagonals(raw, paths, points, raw(points), volumes, 1000);
            for (const LadderPath& path : paths) {
                if (path.thickness == infinity) continue;
                ++measured;
                // x - y changes by a sixth of the way beside the diagonal until it is 0.83 widths.
                EXPECT_NEAR(std::log2(path.thickness * path.reach[0] / (6 * 0.83 * width)), 0, 1.2);
            }
        }
        EXPECT_EQ(measured, f == &ridge ? 40 : 0);
    }
}

} // namespace
} // namespace montelux
