#include "sampler_kinds.h"
#include "uniformity.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <set>
#include <string>
#include <vector>

#include "montelux/mc/random/sample_stream.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/mc/stats/z_test.h"

namespace montelux {
namespace {

using testing::is_net;
using testing::uniform_square_p_value;

using testing::all_kinds;
using testing::kind_name;

// The renderer's pattern of draws: a pair, a number, a pair, ...
std::vector<double> draw(SampleStream stream, int numbers) {
    std::vector<double> u;
    while (static_cast<int>(u.size()) < numbers) {
        const Vec2f pair = stream.next_2d();
        const float single = stream.next_1d();
        u.insert(u.end(), {pair.x, pair.y, single});
    }
    return u;
}

class SampleStreamOf : public ::testing::TestWithParam<SamplerKind> {};

INSTANTIATE_TEST_SUITE_P(Kinds, SampleStreamOf, ::testing::ValuesIn(all_kinds), kind_name);

// The bits below a number are uniform and know nothing of it, nor of those of the next number; two tests a
// kind at 1e-9.
TEST_P(SampleStreamOf, RefinedNumbersHaveRandomBitsBelow) {
    std::vector<Vec2d> beside, next;
    for (std::uint64_t s = 0; s < 40000; ++s) {
        const SamplerSettings settings{GetParam(), s / 640, 64, 1};
        SampleStream stream(settings, static_cast<std::uint32_t>(s / 64 % 10), 3, s % 64);
        double below[2];
        float u = 0;
        for (double& b : below) {
            u = stream.next_1d();
            const double refined = stream.refined(u);
            b = (refined - static_cast<double>(u)) * 0x1p24;
            ASSERT_TRUE(b >= 0 && b < 1 && refined < 1);
        }
        beside.emplace_back(static_cast<double>(u), below[1]);
        next.emplace_back(below[0], below[1]);
    }
    EXPECT_GT(uniform_square_p_value(beside, 16, 16), 1e-9);
    EXPECT_GT(uniform_square_p_value(next, 16, 16), 1e-9);
}

// False alarms: 324 tests a kind at 1e-9, 2e-6 in all.
TEST_P(SampleStreamOf, EachNumberAndEachPairOfOneSampleIsUniform) {
    constexpr int seeds = 20000, numbers = 36;
    // A power of two, a number that fills no grid, and a sample of a later replicate.
    struct Case {
        std::uint32_t samples, replicates;
        std::uint64_t index;
    };
    for (const Case& c : {Case{64, 1, 0}, Case{64, 1, 37}, Case{51, 3, 16}, Case{51, 3, 40}}) {
        std::vector<std::vector<double>> draws;
        for (int s = 0; s < seeds; ++s) {
            const SamplerSettings settings{GetParam(), std::uint64_t(s), c.samples, c.replicates};
            draws.push_back(draw(SampleStream(settings, 17, 5, c.index), numbers));
        }
        for (int d = 0; d < numbers; ++d) {
            for (int e : {d + 1, d + 4, (d * 7 + 11) % numbers}) {
                if (e >= numbers || e == d) continue;
                std::vector<Vec2d> points;
                for (const auto& u : draws) points.emplace_back(u[d], u[e]);
                EXPECT_GT(uniform_square_p_value(points, 16, 12), 1e-9)
                    << "numbers " << d << " and " << e << " of sample " << c.index << " of " << c.samples;
            }
        }
    }
}

// Numbers of a branch and the same ones of another branch, of the sample itself, of a branch that began a number later, of
// a branch of a branch, and of another sample's. False alarms: 25 tests a kind at 1e-9.
TEST_P(SampleStreamOf, BranchesAreIndependent) {
    constexpr int seeds = 20000;
    std::array<std::array<std::vector<Vec2d>, 5>, 5> pairs;
    for (int s = 0; s < seeds; ++s) {
        const auto stream = [&](std::uint32_t x, std::uint64_t index) {
            SampleStream begun({GetParam(), std::uint64_t(s), 64, 1}, x, 5, index);
            begun.next_2d();
            return begun;
        };
        const SampleStream sample = stream(17, 21);
        const SampleStream branch = sample.branch(1), second = sample.branch(2), nested = branch.branch(1);
        const SampleStream other = stream(17, 22).branch(1), of_pixel = stream(18, 21).branch(1);
        SampleStream later = sample;
        later.next_1d();
        const auto of_branch = draw(branch, 6);
        const std::array others{draw(second, 6), draw(sample, 6), draw(later.branch(1), 6), draw(nested, 6),
                                draw(s % 2 == 0 ? other : of_pixel, 6)};
        for (std::size_t o = 0; o < others.size(); ++o)
            for (std::size_t d = 0; d < 5; ++d) pairs[o][d].emplace_back(of_branch[d], others[o][d]);
    }
    for (std::size_t o = 0; o < pairs.size(); ++o)
        for (std::size_t d = 0; d < pairs[o].size(); ++d)
            EXPECT_GT(uniform_square_p_value(pairs[o][d], 16, 12), 1e-9) << o << " " << d;
}

// Triples see dependences that pairs hide. False alarms: 4 tests a kind at 1e-9.
TEST_P(SampleStreamOf, TriplesOfOneSampleAreUniform) {
    constexpr int seeds = 50000;
    for (std::array<int, 3> of : {std::array{0, 1, 2}, {0, 3, 4}, {14, 15, 16}, {18, 19, 20}}) {
        std::vector<double> observed(512, 0.0);
        for (int s = 0; s < seeds; ++s) {
            const auto u = draw(SampleStream({GetParam(), 77u + s, 64, 1}, 3, 1, 21), 24);
            int cell = 0;
            for (int d : of) cell = 8 * cell + static_cast<int>(8 * u[d]);
            ++observed[cell];
        }
        const std::vector<double> expected(512, seeds / 512.0);
        EXPECT_GT(chi_squared_test(observed, expected).p_value, 1e-9) << of[0] << of[1] << of[2];
    }
}

// The same number of two samples. False alarms: 24 tests a kind at 1e-9.
TEST_P(SampleStreamOf, ReplicatesAndPixelsAreIndependent) {
    constexpr int seeds = 20000, numbers = 24;
    std::vector<std::vector<Vec2d>> replicates(numbers), pixels(numbers);
    for (int s = 0; s < seeds; ++s) {
        const SamplerSettings settings{GetParam(), std::uint64_t(s), 64, 4};
        const auto a = draw(SampleStream(settings, 8, 9, 5), numbers);
        const auto b = draw(SampleStream(settings, 8, 9, 21), numbers);
        const auto c = draw(SampleStream(settings, 9, 9, 5), numbers);
        for (int d = 0; d < numbers; ++d) {
            replicates[d].emplace_back(a[d], b[d]);
            pixels[d].emplace_back(a[d], c[d]);
        }
    }
    for (int d = 0; d < numbers; ++d) {
        EXPECT_GT(uniform_square_p_value(replicates[d], 16, 16), 1e-9) << "number " << d;
        if (GetParam() == SamplerKind::sobol_blue_noise) continue; // its pixels avoid each other on purpose
        EXPECT_GT(uniform_square_p_value(pixels[d], 16, 16), 1e-9) << "number " << d;
    }
}

TEST_P(SampleStreamOf, IsAPureFunctionOfItsKey) {
    const SamplerSettings settings{GetParam(), 99, 64, 4};
    std::vector<std::vector<double>> forward, backward(130);
    for (int i = 0; i < 130; ++i) forward.push_back(draw(SampleStream(settings, 4, 2, i), 300));
    for (int i = 129; i >= 0; --i) backward[i] = draw(SampleStream(settings, 4, 2, i), 300);
    EXPECT_EQ(forward, backward);
    EXPECT_NE(forward[0], draw(SampleStream(settings, 2, 4, 0), 300));
    EXPECT_NE(forward[0], draw(SampleStream({GetParam(), 100, 64, 4}, 4, 2, 0), 300));
    // Samples past spp are new ones.
    EXPECT_NE(forward[0], forward[64]);
    EXPECT_NE(forward[0], forward[128]);
    EXPECT_NE(forward[1], draw(SampleStream(settings, 4, 2, 1 + (std::uint64_t{1} << 40)), 300));
}

// Means over replicates against the truth. The integrand: a product over 12 numbers, integral 1, and a half
// plane in the first pair. False alarms: 2 tests a kind at 1e-7.
TEST_P(SampleStreamOf, ReplicatesAreUnbiasedAndNoWorseThanIndependentSamples) {
    constexpr int seeds = 1500, n = 64;
    RunningMoments smooth, edge;
    for (int s = 0; s < seeds; ++s) {
        double sum_smooth = 0, sum_edge = 0;
        for (int i = 0; i < n; ++i) {
            const auto u = draw(SampleStream({GetParam(), std::uint64_t(s), n, 1}, 0, 0, i), 12);
            double f = 1;
            for (int d = 0; d < 12; ++d) f *= 1 + std::pow(0.7, d) * (u[d] - 0.5);
            sum_smooth += f;
            sum_edge += u[0] + 0.5 * u[1] < 0.75;
        }
        smooth.add(sum_smooth / n);
        edge.add(sum_edge / n);
    }
    const auto smooth_result = unbiasedness_test(smooth, 1.0);
    const auto edge_result = unbiasedness_test(edge, 0.5);
    EXPECT_TRUE(smooth_result.passes(1e-7)) << smooth_result.description;
    EXPECT_TRUE(edge_result.passes(1e-7)) << edge_result.description;
    double product = 1;
    for (int d = 0; d < 12; ++d) product *= 1 + std::pow(0.49, d) / 12;
    const double independent_smooth = (product - 1) / n, independent_edge = 0.25 / n;
    const bool independent = GetParam() == SamplerKind::independent;
    // The ratio of a variance estimated from 1500 replicates has a standard deviation of 3.7 %.
    const double smooth_factor = independent ? 1.25 : 0.1, edge_factor = independent ? 1.25 : 0.35;
    EXPECT_LT(smooth.variance(), smooth_factor * independent_smooth);
    EXPECT_LT(edge.variance(), edge_factor * independent_edge);
    if (independent) {
        EXPECT_GT(smooth.variance(), 0.75 * independent_smooth);
        EXPECT_GT(edge.variance(), 0.75 * independent_edge);
    }
}

TEST_P(SampleStreamOf, DegenerateSettingsStillGiveNumbers) {
    for (std::uint32_t samples : {0u, 1u, 2u, 3u})
        for (std::uint32_t replicates : {0u, 1u, 7u})
            for (std::uint64_t index : {std::uint64_t{0}, std::uint64_t{5}, ~std::uint64_t{0}})
                for (double u :
                     draw(SampleStream({GetParam(), 1, samples, replicates}, ~0u, ~0u, index), 600)) {
                    EXPECT_GE(u, 0);
                    EXPECT_LT(u, 1);
                }
}

std::vector<Vec2d> pairs_of_replicate(SamplerKind kind, std::uint32_t n, int skip_pairs) {
    std::vector<Vec2d> points;
    for (std::uint32_t i = 0; i < n; ++i) {
        SampleStream stream({kind, 31, n, 1}, 6, 7, i);
        for (int k = 0; k < skip_pairs; ++k) stream.next_2d();
        points.push_back(Vec2d(stream.next_2d()));
    }
    return points;
}

TEST(SampleStream, SobolPairsAreNets) {
    for (std::uint32_t n : {16u, 64u, 1024u}) {
        EXPECT_TRUE(is_net(pairs_of_replicate(SamplerKind::sobol, n, 0), 0)) << n;
        EXPECT_TRUE(is_net(pairs_of_replicate(SamplerKind::sobol, n, 8), 0)) << n;
        EXPECT_TRUE(is_net(pairs_of_replicate(SamplerKind::sobol, n, 40), 0)) << n;
        EXPECT_TRUE(is_net(pairs_of_replicate(SamplerKind::sobol_blue_noise, n, 0), 0)) << n;
        EXPECT_TRUE(is_net(pairs_of_replicate(SamplerKind::sobol_blue_noise, n, 9), 0)) << n;
    }
    EXPECT_FALSE(is_net(pairs_of_replicate(SamplerKind::independent, 64, 0), 0));
}

TEST(SampleStream, SobolPairsNeverStraddlePaddedSets) {
    std::vector<Vec2d> points;
    for (std::uint32_t i = 0; i < 256; ++i) {
        SampleStream stream({SamplerKind::sobol, 31, 256, 1}, 6, 7, i);
        for (int k = 0; k < 19; ++k) stream.next_1d();
        points.push_back(Vec2d(stream.next_2d()));
    }
    EXPECT_TRUE(is_net(points, 0));
}

TEST(SampleStream, BlueNoisePixelsOfABlockShareANet) {
    for (int skip : {0, 3}) {
        std::vector<Vec2d> points;
        for (std::uint32_t y = 8; y < 16; ++y)
            for (std::uint32_t x = 24; x < 32; ++x)
                for (std::uint32_t i = 0; i < 8; ++i) {
                    SampleStream stream({SamplerKind::sobol_blue_noise, 5, 16, 2}, x, y, i);
                    for (int k = 0; k < skip; ++k) stream.next_1d();
                    points.push_back(Vec2d(stream.next_2d()));
                }
        EXPECT_TRUE(is_net(points, 0)) << skip;
    }
}

// Pixels at the same place of different tiles.
TEST(SampleStream, BlueNoiseTilesDoNotRepeatNumbers) {
    constexpr std::uint32_t width = 4096;
    std::set<std::vector<double>> different;
    for (std::uint32_t row = 0; row < 3; ++row)
        for (std::uint32_t column = 0; column < 3; ++column)
            different.insert(draw(SampleStream({SamplerKind::sobol_blue_noise, 5, 16, 2}, column * width + 7,
                                               row * width + 9, 3),
                                  6));
    EXPECT_EQ(different.size(), 9u);
}

// All 24 permutations alike at the top digit and below a prefix. False alarms: 2 at 1e-9.
TEST(ShuffleQuads, IsANestedRandomPermutation) {
    std::vector<bool> seen(1 << 9, false);
    for (std::uint64_t i = 0; i < seen.size(); ++i) seen[shuffle_quads(i, 9, 77)] = true;
    EXPECT_EQ(std::count(seen.begin(), seen.end(), true), 1 << 9);
    for (std::uint64_t prefix : {0u, 2u}) {
        std::vector<double> observed(256, 0.0), expected(256, 0.0);
        for (std::uint8_t p : quad_permutations) expected[p] = 24000 / 24.0;
        for (std::uint64_t s = 0; s < 24000; ++s) {
            std::uint64_t images = 0;
            for (std::uint64_t d = 0; d < 4; ++d)
                images |= (shuffle_quads(prefix << 2 | d, 4, mix64(s)) & 3u) << (2 * d);
            ++observed[images];
        }
        EXPECT_GT(chi_squared_test(observed, expected).p_value, 1e-9) << prefix;
    }
}

TEST(SampleStream, StratifiedDrawsFillStrata) {
    constexpr int n = 36;
    const auto pairs = pairs_of_replicate(SamplerKind::stratified, n, 2);
    std::array<int, n> cell{}, column{}, row{};
    for (const Vec2d& p : pairs) {
        ++cell[static_cast<int>(6 * p.y) * 6 + static_cast<int>(6 * p.x)];
        ++column[static_cast<int>(n * p.x)];
        ++row[static_cast<int>(n * p.y)];
    }
    std::array<int, n> ones;
    ones.fill(1);
    EXPECT_EQ(cell, ones);
    EXPECT_EQ(column, ones);
    EXPECT_EQ(row, ones);
}

TEST(SampleStream, HaltonAndHammersleyNumbersFillTheirStrata) {
    const auto counts = [](SamplerKind kind, std::uint32_t n, int skip) {
        std::vector<int> c(n, 0);
        for (std::uint32_t i = 0; i < n; ++i) {
            SampleStream stream({kind, 8, n, 1}, 1, 2, i);
            for (int k = 0; k < skip; ++k) stream.next_1d();
            ++c[static_cast<int>(n * stream.next_1d())];
        }
        return c;
    };
    EXPECT_EQ(counts(SamplerKind::halton, 64, 0), std::vector<int>(64, 1));
    EXPECT_EQ(counts(SamplerKind::halton, 81, 1), std::vector<int>(81, 1));
    EXPECT_EQ(counts(SamplerKind::halton, 49, 3), std::vector<int>(49, 1));
    EXPECT_EQ(counts(SamplerKind::hammersley, 50, 0), std::vector<int>(50, 1));
    EXPECT_EQ(counts(SamplerKind::hammersley, 64, 1), std::vector<int>(64, 1));
    EXPECT_NE(counts(SamplerKind::independent, 64, 0), std::vector<int>(64, 1));
}

// The corner pixel of a tile and the first samples of a replicate have all indices zero: hashes of such keys
// must not meet. False alarms: 72 tests at 6 standard errors, 1.4e-7.
TEST_P(SampleStreamOf, FirstSamplesOfTheFirstPixelHaveIndependentNumbers) {
    constexpr int seeds = 20000, numbers = 4;
    for (std::uint32_t points : {1u, 2u, 4u, 8u})
        for (std::uint32_t i = 0; i < std::min(points, 3u); ++i) {
            int all_low = 0;
            for (int seed = 0; seed < seeds; ++seed) {
                SampleStream stream({GetParam(), static_cast<std::uint64_t>(seed), points, 1}, 0, 0, i);
                bool low = true;
                for (int d = 0; d < numbers; ++d) {
                    const float u = stream.next_1d();
                    low = low && u < 0.5f;
                }
                all_low += low;
            }
            const double p = std::pow(0.5, numbers);
            EXPECT_NEAR(double(all_low) / seeds, p, 6 * std::sqrt(p * (1 - p) / seeds)) << points << ' ' << i;
        }
}

TEST(SamplerSettings, ReplicatesAreConsecutiveRuns) {
    const SamplerSettings s{SamplerKind::sobol, 0, 10, 4};
    EXPECT_EQ(points_per_replicate(s), 3u);
    EXPECT_EQ(replicate_of(s, 0), 0u);
    EXPECT_EQ(replicate_of(s, 2), 0u);
    EXPECT_EQ(replicate_of(s, 3), 1u);
    EXPECT_EQ(replicate_of(s, 9), 3u);
    EXPECT_EQ(replicate_of(s, 12), 4u); // past spp
    EXPECT_EQ(index_in_replicate(s, 11), 2u);
    EXPECT_EQ(points_per_replicate({SamplerKind::sobol, 0, 0, 0}), 1u);
    EXPECT_EQ(points_per_replicate({SamplerKind::sobol, 0, 4'294'967'295u, 1}), 4'294'967'295u);
}

} // namespace
} // namespace montelux
