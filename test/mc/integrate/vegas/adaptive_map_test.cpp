#include "test/temporary_folder.h"
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <gtest/gtest.h>

#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/integrate/vegas/adaptive_map.h"
#include "montelux/mc/integrate/vegas/hypercubes.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// Training data of n equidistant points in each coordinate for f(x_1) in the first and 1 in the others.
template <typename F>
MapTraining train(const AdaptiveMap& map, const F& f, std::size_t n = 1 << 14) {
    PointBuffer y(n, map.dimensions()), x(n, map.dimensions());
    for (int d = 0; d < map.dimensions(); ++d)
        for (std::size_t i = 0; i < n; ++i) y(i, d) = (static_cast<double>(i) + 0.5) / static_cast<double>(n);
    std::vector<double> jacobian(n, 1.0), share(n, 1 / static_cast<double>(n)), square(n);
    map.map(y, x, jacobian);
    for (std::size_t i = 0; i < n; ++i) {
        const std::span<const double> edge = map.edges(0);
        const auto k = static_cast<std::size_t>(y(i, 0) * map.increments());
        const double factor = map.increments() * (edge[k + 1] - edge[k]);
        square[i] = share[i] * std::pow(f(x(i, 0)) * factor, 2);
    }
    MapTraining training(map.dimensions(), map.increments());
    training.add(y, share, square);
    return training;
}

TEST(AdaptiveMap, IdentityLeavesPointsWhereTheyAre) {
    const AdaptiveMap map(3, 10);
    PointBuffer y(100, 3), x(100, 3);
    fill_random(y, 1, 0, 0);
    std::vector<double> jacobian(100, 2.0);
    map.map(y, x, jacobian);
    for (std::size_t i = 0; i < 100; ++i) {
        EXPECT_NEAR(jacobian[i], 2, 1e-13);
        for (int d = 0; d < 3; ++d) EXPECT_NEAR(x(i, d), y(i, d), 1e-15);
    }
}

TEST(AdaptiveMap, InverseComesBackWithTheSameJacobian) {
    AdaptiveMap map(2, 37);
    for (int k = 0; k < 5; ++k) map.refine(train(map, [](double x) { return std::exp(-30 * x); }), 1);
    PointBuffer y(1000, 2), x(1000, 2), back(1000, 2);
    fill_random(y, 2, 0, 0);
    std::vector<double> forth(1000, 1.0), inverse(1000, 1.0);
    map.map(y, x, forth);
    map.inverse(x, back, inverse);
    for (std::size_t i = 0; i < 1000; ++i) {
        EXPECT_NEAR(inverse[i] / forth[i], 1, 1e-12);
        for (int d = 0; d < 2; ++d) EXPECT_NEAR(back(i, d), y(i, d), 1e-10);
    }
}

// The density of the map that makes f |dx/dy| constant is f over its integral.
TEST(AdaptiveMap, IncrementsBecomeQuantilesOfThePositiveFunctionItLearns) {
    AdaptiveMap map(1, 64);
    for (int k = 0; k < 40; ++k) map.refine(train(map, [](double x) { return 1 + 4 * x; }), 1);
    for (std::size_t k = 0; k <= 64; ++k) {
        const double x = map.edges(0)[k], mass = (x + 2 * x * x) / 3;
        EXPECT_NEAR(mass, static_cast<double>(k) / 64, 2e-3) << k;
    }
}

// Beyond a jump there is nothing to learn from, but the increment that holds it must stay narrow.
TEST(AdaptiveMap, IncrementsGrowStepByStepBesideAJump) {
    AdaptiveMap map(1, 128);
    const double jump = 0.4;
    for (int k = 0; k < 30; ++k)
        map.refine(train(map, [&](double x) { return x < jump ? std::exp(20 * (x - jump)) : 0; }), 1);
    std::span<const double> edge = map.edges(0);
    std::size_t at = 0;
    while (edge[at + 1] < jump) ++at;
    EXPECT_LT(edge[at + 1] - edge[at], 0.01);
    for (std::size_t k = 1; k < 127; ++k)
        EXPECT_LT(edge[k + 1] - edge[k], 4.5 * (edge[k] - edge[k - 1])) << k;
}

TEST(AdaptiveMap, WidthsSurviveADeltaFunction) {
    AdaptiveMap map(1, 256);
    for (int k = 0; k < 200; ++k)
        map.refine(train(map, [](double x) { return std::exp(-1e24 * (x - 0.3) * (x - 0.3)); }), 2);
    for (std::size_t k = 0; k < 256; ++k) EXPECT_GT(map.edges(0)[k + 1] - map.edges(0)[k], 1e-15) << k;
}

TEST(AdaptiveMap, FileBringsTheMapBack) {
    AdaptiveMap map(3, 50);
    map.refine(train(map, [](double x) { return x * x; }), 0.7);
    const TemporaryFolder folder;
    const std::string path = (folder / "map").string();
    map.save(path);
    EXPECT_EQ(AdaptiveMap::load(path), map);
    std::filesystem::resize_file(path, std::filesystem::file_size(path) - 8);
    EXPECT_THROW(AdaptiveMap::load(path), Error);
    std::filesystem::remove(path);
    EXPECT_THROW(AdaptiveMap::load(path), Error);
}

TEST(AdaptiveMap, ImpossibleEdgesAreRefused) {
    EXPECT_THROW(AdaptiveMap(0), Error);
    EXPECT_THROW(AdaptiveMap(1, 0), Error);
    EXPECT_THROW(AdaptiveMap({{0, 0.5, 0.9}}), Error);
    EXPECT_THROW(AdaptiveMap({{0, 0.6, 0.5, 1}}), Error);
    EXPECT_THROW(AdaptiveMap({{0, 0.5, 1}, {0, 1}}), Error);
    EXPECT_NO_THROW(AdaptiveMap({{0, 0.2, 1}, {0, 0.7, 1}}));
}

TEST(Hypercubes, GridIsTheFinestThatFits) {
    Hypercubes cubes(3);
    cubes.resize(100);
    EXPECT_EQ(cubes.count(), 100u); // 5 x 5 x 4
    EXPECT_EQ(cubes.strata(0), 5);
    EXPECT_EQ(cubes.strata(2), 4);
    Hypercubes many(40);
    many.resize(1000);
    EXPECT_EQ(many.count(), 512u);
}

TEST(Hypercubes, PointsGoWhereTheSpreadIsAndNeverExceedTheNumber) {
    Hypercubes cubes(1);
    cubes.resize(100);
    std::vector<double> variances(100, 0.0);
    variances[30] = 4;
    variances[31] = 1;
    cubes.learn(variances);
    for (std::uint64_t n : {200u, 801u, 10007u}) {
        const auto counts = cubes.allocate(n, 1);
        std::uint64_t sum = 0;
        for (std::uint32_t c : counts) {
            EXPECT_GE(c, 2u);
            sum += c;
        }
        EXPECT_LE(sum, n);
        EXPECT_GE(counts[30], counts[31]);
    }
    // A finer grid remembers.
    cubes.resize(200);
    const auto counts = cubes.allocate(8000, 1);
    EXPECT_GT(counts[60], 10 * counts[0]);
    EXPECT_EQ(counts[60], counts[61]);
}

TEST(Hypercubes, PointsFallIntoTheirBoxes) {
    Hypercubes cubes(3);
    cubes.resize(100);
    PointBuffer u(100, 3);
    fill_random(u, 5, 0, 0);
    std::vector<double> box(100);
    for (std::size_t i = 0; i < 100; ++i) box[i] = static_cast<double>(i);
    cubes.place(u, box);
    for (int h = 0; h < 100; ++h) {
        EXPECT_EQ(static_cast<int>(u(h, 0) * 5), h % 5);
        EXPECT_EQ(static_cast<int>(u(h, 1) * 5), h / 5 % 5);
        EXPECT_EQ(static_cast<int>(u(h, 2) * 4), h / 25);
    }
}

} // namespace
} // namespace montelux
