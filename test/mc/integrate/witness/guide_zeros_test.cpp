#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <utility>
#include <vector>

#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/integrate/witness/guide_zeros.h"

namespace montelux {
namespace {

using Guide = Integrand::BatchFunction;

Guide guide_of(double (*g)(std::span<const double> x)) {
    const Integrand f(g);
    return [f](const PointBatch& x, ValueBatch y) { f(x, y); };
}

std::vector<double> point_of(const Domain& domain, const std::vector<double>& u) {
    PointBuffer at(1, domain.uniforms()), x(1, domain.dimensions());
    for (std::size_t d = 0; d < u.size(); ++d) at(0, static_cast<int>(d)) = u[d];
    std::vector<double> volume{1}, point(static_cast<std::size_t>(domain.dimensions()));
    domain.map(at, x, volume);
    x.view().gather(0, point.data());
    return point;
}

// exp(-1e7 g) is zero but for 1/10^5 of the square, and its slope with it.
TEST(GuideZeros, AllRootsOfTwoSquares) {
    const std::vector<Guide> guides{guide_of([](std::span<const double> x) {
        return std::pow(x[0] * x[0] - x[1], 2) + std::pow(x[1] * x[1] - 2 * x[0], 2);
    })};
    const Domain square{{-5, 5}, {-5, 5}};
    const std::vector<std::vector<double>> roots{{0, 0}, {std::cbrt(2.0), std::cbrt(4.0)}};
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const std::vector<GuideZero> zeros = guide_zeros(guides, square, seed);
        for (const auto& expected : roots)
            EXPECT_EQ(std::ranges::count_if(zeros,
                                            [&](const GuideZero& zero) {
                                                const std::vector<double> x = point_of(square, zero.u);
                                                return std::hypot(x[0] - expected[0], x[1] - expected[1]) <
                                                       1e-6;
                                            }),
                      1)
                << seed;
        EXPECT_EQ(zeros.size(), roots.size()) << seed;
    }
}

TEST(GuideZeros, PointsOfCurvesAndPolesOfSpheres) {
    const Domain square{{-1, 1}, {-1, 1}}, sphere = Domain::sphere({0, 0, 0});
    const std::vector<Guide> ring{
        guide_of([](std::span<const double> x) { return std::hypot(x[0], x[1]) - 0.7; })};
    const std::vector<Guide> poles{guide_of([](std::span<const double> x) { return std::abs(x[2]) - 1; })};
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const std::vector<GuideZero> on_ring = guide_zeros(ring, square, seed);
        EXPECT_GT(on_ring.size(), 3u) << seed;
        for (const GuideZero& zero : on_ring) {
            const std::vector<double> x = point_of(square, zero.u);
            EXPECT_NEAR(std::hypot(x[0], x[1]), 0.7, 1e-10) << seed;
        }
        double highest = 0, lowest = 0;
        for (const GuideZero& zero : guide_zeros(poles, sphere, seed)) {
            const double z = point_of(sphere, zero.u)[2];
            EXPECT_NEAR(std::abs(z), 1, 1e-9) << seed;
            highest = std::max(highest, z);
            lowest = std::min(lowest, z);
        }
        EXPECT_GT(highest - lowest, 1.9) << seed;
    }
}

// Two caps, one of which lies where the azimuth begins: climbs end at the face between its halves.
TEST(GuideZeros, CapsWhereTheAzimuthBegins) {
    const Domain sphere = Domain::sphere({0, 0, 0});
    const std::vector<Guide> caps{guide_of([](std::span<const double> x) { return x[0] * x[1] - 0.4999; })};
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        std::array<int, 2> found{};
        for (const GuideZero& zero : guide_zeros(caps, sphere, seed)) {
            const std::vector<double> x = point_of(sphere, zero.u);
            EXPECT_NEAR(x[0] * x[1], 0.4999, 1e-10) << seed;
            ++found[x[0] > 0];
        }
        EXPECT_GT(found[0], 0) << seed;
        EXPECT_GT(found[1], 0) << seed;
    }
}

TEST(GuideZeros, OthersThanTheVariablesOfAGuideAreInTheMiddle) {
    const std::vector<Guide> guides{guide_of([](std::span<const double> x) { return x[1] * x[1] - 0.25; }),
                                    guide_of([](std::span<const double> x) { return x[0] - 0.5; })};
    const std::vector<GuideZero> zeros = guide_zeros(guides, Domain({{0, 1}, {0, 1}, {0, 1}}), 1);
    ASSERT_EQ(zeros.size(), 1u); // the second one's is the same point
    EXPECT_EQ(zeros[0].guide, 0u);
    for (double u : zeros[0].u) EXPECT_NEAR(u, 0.5, 1e-10);
}

TEST(GuideZeros, NoneWhereAGuideHasNone) {
    const std::vector<Guide> guides{
        guide_of([](std::span<const double> x) { return 1 + x[0] * x[0] + x[1] * x[1]; }),
        guide_of([](std::span<const double> x) { return x[0] * x[1]; }), // at the ends alone
        guide_of([](std::span<const double> x) { return std::sqrt(x[0] - 2); })};
    for (std::uint64_t seed = 0; seed < 20; ++seed)
        EXPECT_TRUE(guide_zeros(guides, Domain::unit_cube(2), seed).empty()) << seed;
}

TEST(GuideZeros, ClimbsBesideAFixedVariable) {
    const Guide guide = guide_of([](std::span<const double> x) { return x[1] - std::sqrt(x[0]); });
    const Domain quadrant{{0, infinity}, {0, infinity}};
    for (double k : {3.0, 6.0, 9.0, 12.0}) {
        const std::vector<double> u = climb_to_zero(guide, quadrant, {1 - std::exp2(-k), 0.5}, 0);
        EXPECT_EQ(u[0], 1 - std::exp2(-k));
        const std::vector<double> x = point_of(quadrant, u);
        EXPECT_NEAR(x[1] / std::sqrt(x[0]), 1, 1e-6) << k;
    }
}

} // namespace
} // namespace montelux
