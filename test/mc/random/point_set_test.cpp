#include "uniformity.h"
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <tuple>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/mc/random/owen.h"
#include "montelux/mc/random/point_set.h"
#include "montelux/mc/random/prime_base.h"
#include "montelux/mc/random/sobol.h"
#include "montelux/mc/random/van_der_corput.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/mc/stats/z_test.h"

namespace montelux {
namespace {

using testing::is_net;

std::vector<Vec2d> points(const PointSet& set, int x, int y) {
    std::vector<Vec2d> p;
    for (std::uint32_t i = 0; i < set.settings().count; ++i) p.emplace_back(set(i, x), set(i, y));
    return p;
}

void expect_first_points(PointSetKind kind, const std::vector<std::vector<double>>& expected) {
    const int dimensions = static_cast<int>(expected[0].size());
    const PointSet set({kind, dimensions, 8, Randomisation::none, 0});
    for (std::uint32_t i = 0; i < expected.size(); ++i)
        for (int d = 0; d < dimensions; ++d)
            EXPECT_NEAR(set(i, d), expected[i][d], 1e-9) << to_string(kind) << " " << i << " " << d;
}

TEST(PointSet, KnownFirstPoints) {
    expect_first_points(PointSetKind::halton, {{0, 0, 0},
                                               {1 / 2., 1 / 3., 1 / 5.},
                                               {1 / 4., 2 / 3., 2 / 5.},
                                               {3 / 4., 1 / 9., 3 / 5.},
                                               {1 / 8., 4 / 9., 4 / 5.},
                                               {5 / 8., 7 / 9., 1 / 25.}});
    expect_first_points(
        PointSetKind::hammersley,
        {{0, 0, 0}, {1 / 8., 1 / 2., 1 / 3.}, {2 / 8., 1 / 4., 2 / 3.}, {3 / 8., 3 / 4., 1 / 9.}});
    // Joe and Kuo's program, points 0 to 4 sorted out of Gray code order.
    expect_first_points(PointSetKind::sobol, {{0, 0, 0, 0},
                                              {0.5, 0.5, 0.5, 0.5},
                                              {0.25, 0.75, 0.75, 0.75},
                                              {0.75, 0.25, 0.25, 0.25},
                                              {0.125, 0.625, 0.375, 0.125}});
    const double r1 = (std::sqrt(5.0) - 1) / 2, r2 = 1 / 1.32471795724474602596;
    const auto fraction = [](double v) { return v - std::floor(v); };
    expect_first_points(PointSetKind::golden_ratio, {{fraction(0.5 + r1)}, {fraction(0.5 + 2 * r1)}});
    expect_first_points(PointSetKind::golden_ratio, {{fraction(0.5 + r2), fraction(0.5 + r2 * r2)},
                                                     {fraction(0.5 + 2 * r2), fraction(0.5 + 2 * r2 * r2)}});
    expect_first_points(PointSetKind::weyl, {{0, 0, 0},
                                             {0.41421356237, 0.73205080757, 0.2360679775},
                                             {0.82842712475, 0.46410161514, 0.472135955}});
}

TEST(VanDerCorput, AgreesWithItsDefinition) {
    for (int b : {0, 1, 2, 10, 127, 1023}) {
        const PrimeBase& base = prime_bases[b];
        for (std::uint32_t i : {1u, 2u, 97u, 8161u, 123456789u, 4294967295u}) {
            double value = 0, place = 1;
            for (std::uint64_t rest = i; rest != 0; rest /= base.base)
                value += static_cast<double>(rest % base.base) * (place /= base.base);
            EXPECT_NEAR(radical_inverse(i, base), value, 1e-14) << base.base << " " << i;
            EXPECT_EQ(base.quotient(i), i / base.base);
            EXPECT_EQ(base.remainder(i), i % base.base);
        }
    }
}

// Two digits with a common prefix go to every ordered pair of distinct digits alike. False alarms: 2 at 1e-9.
TEST(VanDerCorput, ScrambledDigitsArePairwiseUniform) {
    const PrimeBase& base = prime_bases[2];
    for (std::uint32_t step : {1u, 5u}) { // the first digit, and the second
        std::vector<double> observed(25, 0.0), expected(25, 40000 / 20.0);
        for (int i = 0; i < 5; ++i) expected[6 * i] = 0;
        for (std::uint64_t s = 0; s < 40000; ++s) {
            const auto digit = [&](std::uint32_t index) {
                return static_cast<int>(scrambled_radical_inverse(index, base, mix64(s), 25) * 5 * step) % 5;
            };
            ++observed[digit(1 * step) * 5 + digit(3 * step)];
        }
        EXPECT_GT(chi_squared_test(observed, expected).p_value, 1e-9) << step;
    }
}

TEST(Sobol, AllMatricesAreTriangularAndTablesAgree) {
    for (int d = 0; d < sobol_dimensions; ++d)
        for (int k = 0; k < sobol_bits; ++k)
            // Exactly the low 31 - k bits are clear below a set one: each dimension alone is a
            // (0,1)-sequence.
            ASSERT_EQ(sobol_columns(d)[k] << k, 0x80000000u) << d << " " << k;
}

TEST(Sobol, FastFormsAgreeWithTheMatrices) {
    for (std::uint32_t i : {0u, 1u, 5u, 1000u, 0x12345678u, 0xffffffffu}) {
        for (int d = 0; d < sobol_nibble_dimensions; ++d)
            EXPECT_EQ(reverse_bits(sobol_coordinate_reversed(i, d)), sobol_coordinate(i, sobol_columns(d)));
        EXPECT_EQ(reverse_bits(sobol_second_reversed(i)), sobol_coordinate(i, sobol_columns(1)));
        EXPECT_EQ(static_cast<std::uint32_t>(sobol_second_reversed(std::uint64_t{i})),
                  sobol_second_reversed(i));
    }
    EXPECT_THROW(sobol_columns(sobol_dimensions), Error);
}

TEST(PointSet, SobolProjectionsAreNetsPlainAndScrambled) {
    for (Randomisation r : {Randomisation::none, Randomisation::scramble}) {
        const PointSet set({PointSetKind::sobol, 16, 1024, r, 4});
        EXPECT_TRUE(is_net(points(set, 0, 1), 0));
        // Quality parameters of planar projections, by Joe and Kuo's choice small.
        EXPECT_TRUE(is_net(points(set, 1, 2), 1));
        EXPECT_TRUE(is_net(points(set, 2, 3), 3));
        EXPECT_TRUE(is_net(points(set, 14, 15), 6));
    }
    EXPECT_FALSE(is_net(points(PointSet({PointSetKind::sobol, 2, 1024, Randomisation::shift, 4}), 0, 1), 0));
    EXPECT_TRUE(
        is_net(points(PointSet({PointSetKind::hammersley, 2, 256, Randomisation::none, 0}), 0, 1), 0));
    EXPECT_TRUE(
        is_net(points(PointSet({PointSetKind::hammersley, 2, 256, Randomisation::scramble, 1}), 0, 1), 7));
}

struct Randomised {
    PointSetKind kind;
    Randomisation randomisation;
};

class RandomisedPointSet : public ::testing::TestWithParam<Randomised> {};

INSTANTIATE_TEST_SUITE_P(All, RandomisedPointSet,
                         ::testing::Values(Randomised{PointSetKind::independent, Randomisation::none},
                                           Randomised{PointSetKind::halton, Randomisation::shift},
                                           Randomised{PointSetKind::halton, Randomisation::digit_permutation},
                                           Randomised{PointSetKind::halton, Randomisation::scramble},
                                           Randomised{PointSetKind::hammersley, Randomisation::shift},
                                           Randomised{PointSetKind::hammersley,
                                                      Randomisation::digit_permutation},
                                           Randomised{PointSetKind::hammersley, Randomisation::scramble},
                                           Randomised{PointSetKind::sobol, Randomisation::shift},
                                           Randomised{PointSetKind::sobol, Randomisation::scramble},
                                           Randomised{PointSetKind::golden_ratio, Randomisation::shift},
                                           Randomised{PointSetKind::weyl, Randomisation::shift}),
                         [](const auto& which) {
                             return std::string(to_string(which.param.kind)) + "_" +
                                    std::string(to_string(which.param.randomisation));
                         });

// False alarms: 24 tests a set at 1e-9.
TEST_P(RandomisedPointSet, EachPointIsUniformOverSeeds) {
    constexpr int seeds = 10000;
    constexpr std::array<std::uint32_t, 4> indices = {0, 1, 41, 99};
    constexpr std::array<std::array<int, 2>, 6> planes = {{{0, 1}, {1, 2}, {2, 5}, {5, 0}, {3, 4}, {4, 1}}};
    std::array<std::array<std::vector<Vec2d>, planes.size()>, indices.size()> points;
    for (std::uint64_t s = 0; s < seeds; ++s) {
        const PointSet set({GetParam().kind, 6, 100, GetParam().randomisation, s});
        for (std::size_t i = 0; i < indices.size(); ++i)
            for (std::size_t k = 0; k < planes.size(); ++k)
                points[i][k].emplace_back(set(indices[i], planes[k][0]), set(indices[i], planes[k][1]));
    }
    for (std::size_t i = 0; i < indices.size(); ++i)
        for (std::size_t k = 0; k < planes.size(); ++k)
            EXPECT_GT(testing::uniform_square_p_value(points[i][k], 12, 12), 1e-9)
                << indices[i] << " " << planes[k][0] << " " << planes[k][1];
}

// The integral of the product of 1 + (u - 1/2) over four dimensions is 1. False alarm 1e-7.
TEST_P(RandomisedPointSet, MeansAreUnbiasedAndNoWorseThanIndependentPoints) {
    RunningMoments means;
    for (std::uint64_t s = 0; s < 1000; ++s) {
        const PointSet set({GetParam().kind, 4, 128, GetParam().randomisation, s});
        double sum = 0;
        for (std::uint32_t i = 0; i < 128; ++i) {
            double f = 1;
            for (int d = 0; d < 4; ++d) f *= 0.5 + set(i, d);
            sum += f;
        }
        means.add(sum / 128);
    }
    const auto result = unbiasedness_test(means, 1.0);
    EXPECT_TRUE(result.passes(1e-7)) << result.description;
    const double independent = (std::pow(13 / 12.0, 4) - 1) / 128;
    if (GetParam().kind == PointSetKind::independent)
        EXPECT_NEAR(means.variance() / independent, 1, 0.25);
    else
        EXPECT_LT(means.variance(), 0.5 * independent);
}

TEST(PointSet, RefusesWhatDoesNotExist) {
    EXPECT_THROW(PointSet({PointSetKind::weyl, 2, 8, Randomisation::scramble, 0}), Error);
    EXPECT_THROW(PointSet({PointSetKind::sobol, 2, 8, Randomisation::digit_permutation, 0}), Error);
    EXPECT_THROW(PointSet({PointSetKind::sobol, 1025, 8, Randomisation::none, 0}), Error);
    EXPECT_THROW(PointSet({PointSetKind::halton, 0, 8, Randomisation::none, 0}), Error);
    EXPECT_THROW(PointSet({PointSetKind::halton, 2, 0, Randomisation::none, 0}), Error);
    EXPECT_EQ(point_set_kind("golden_ratio"), PointSetKind::golden_ratio);
    EXPECT_EQ(randomisation("scramble"), Randomisation::scramble);
    EXPECT_FALSE(point_set_kind("sobel"));
}

} // namespace
} // namespace montelux
