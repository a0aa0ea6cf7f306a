#include "test/significance.h"
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <vector>

#include "montelux/mc/dist/quadtree_density.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/chi_squared.h"

namespace montelux {
namespace {

// A narrow peak on a low ground, sampled uniformly.
float peak(Vec2f p) {
    const float x = p.x - 0.3f, y = p.y - 0.8f;
    return 0.1f + 30 * std::exp(-2000 * (x * x + y * y));
}

std::vector<SquareSample> samples_of_peak(int count, std::uint64_t seed) {
    TestUniforms u(seed);
    std::vector<SquareSample> samples;
    for (int i = 0; i < count; ++i) {
        const Vec2f p = u.next_2f();
        samples.push_back({p, peak(p), 1});
    }
    return samples;
}

QuadtreeDensity density_of_peak(int count = 20000) {
    std::vector<SquareSample> samples = samples_of_peak(count, 3);
    return QuadtreeDensity(samples, {});
}

TestResult test_of(const QuadtreeDensity& density) {
    return rectangle_chi_squared_test(
        [&](Vec2d u) -> std::optional<Vec2d> {
            return Vec2d(density.sample({static_cast<float>(u.x), static_cast<float>(u.y)}).p);
        },
        [&](Vec2d p) {
            return double(density.pdf({static_cast<float>(p.x), static_cast<float>(p.y)}));
        },
        {0, 0}, {1, 1}, {.cells_x = 64, .cells_y = 64});
}

TEST(QuadtreeDensity, SamplesFollowTheDensity) {
    for (int count : {1, 50, 20000}) {
        const TestResult r = test_of(density_of_peak(count));
        EXPECT_TRUE(r.passes(significance)) << count << ": " << r.description;
    }
    EXPECT_TRUE(test_of(QuadtreeDensity()).passes(significance));
}

TEST(QuadtreeDensity, ReportedDensityIsThatOfThePoint) {
    const QuadtreeDensity density = density_of_peak();
    TestUniforms u(5);
    for (int i = 0; i < 10000; ++i) {
        const QuadtreeDensity::Sample s = density.sample(u.next_2f());
        ASSERT_GT(s.pdf, 0);
        ASSERT_FLOAT_EQ(s.pdf, density.pdf(s.p));
    }
    for (const Vec2f edge : {Vec2f{0, 0}, Vec2f{1, 1}, Vec2f{0x1.fffffep-1f, 0}})
        EXPECT_GT(density.pdf(edge), 0);
}

TEST(QuadtreeDensity, IsFineWhereTheMassIs) {
    const QuadtreeDensity density = density_of_peak();
    EXPECT_GT(density.pdf({0.3f, 0.8f}), 20 * density.pdf({0.7f, 0.2f}));
    EXPECT_GT(density.node_count(), 10u);
    // Importance sampling with it is better than without.
    TestUniforms u(7);
    double uniform = 0, learned = 0;
    constexpr int count = 20000;
    for (int i = 0; i < count; ++i) {
        const Vec2f v = u.next_2f();
        uniform += std::pow(double(peak(v)), 2) / count;
        const QuadtreeDensity::Sample s = density.sample(v);
        learned += std::pow(double(peak(s.p) / s.pdf), 2) / count;
    }
    EXPECT_LT(learned, 0.2 * uniform);
}

// One half has the mean of the other and values that are 0 in 15 of 16 cases: their mean square is 16 times as large.
TEST(QuadtreeDensity, NoisyRegionsGetTheRootOfTheirMeanSquare) {
    TestUniforms u(11);
    std::vector<SquareSample> samples;
    for (int i = 0; i < 100000; ++i) {
        const Vec2f p = u.next_2f();
        const bool noisy = p.x < 0.5f;
        samples.push_back({p, noisy ? (u.next() < 1.0 / 16 ? 16.0f : 0.0f) : 1.0f, 1});
    }
    const QuadtreeDensity density(samples, {});
    double left = 0;
    for (int i = 0; i < 10000; ++i)
        left += density.pdf(Vec2f{0.5f * u.next_float(), u.next_float()}) * 0.5 / 10000;
    EXPECT_NEAR(left, 0.8, 0.02);
}

// The estimator value / pdf, weighted to the samples that the density was learned from.
TEST(QuadtreeDensity, KnowsItsSecondMoment) {
    const std::vector<SquareSample> samples = samples_of_peak(5000, 11);
    std::vector<SquareSample> learned = samples;
    const QuadtreeDensity density(learned, {.prior_samples = 0});
    double sum = 0;
    for (const SquareSample& s : samples)
        sum += double(s.value) * double(s.value) / double(s.pdf) / double(density.pdf(s.p));
    EXPECT_NEAR(density.second_moment(), sum, 1e-4 * sum);
    // It is least for the finest squares.
    std::vector<SquareSample> coarse = samples;
    EXPECT_GT(QuadtreeDensity(coarse, {.prior_samples = 0, .max_depth = 2}).second_moment(), 1.5 * sum);
    EXPECT_EQ(QuadtreeDensity().second_moment(), 0);
}

TEST(QuadtreeDensity, IsUniformWithoutAValue) {
    std::vector<SquareSample> samples{{{0.5f, 0.5f}, 0, 1}};
    const QuadtreeDensity density(samples, {});
    EXPECT_EQ(density.node_count(), 0u);
    EXPECT_EQ(density.pdf({0.2f, 0.9f}), 1);
}

TEST(QuadtreeDensity, ComesBackFromBytes) {
    const QuadtreeDensity density = density_of_peak();
    ByteWriter out;
    density.save(out);
    const std::vector<std::uint8_t> bytes = out.take();
    ByteReader in(bytes);
    const QuadtreeDensity back = QuadtreeDensity::load(in);
    EXPECT_TRUE(in.at_end());
    TestUniforms u(13);
    for (int i = 0; i < 1000; ++i) {
        const Vec2f v = u.next_2f();
        ASSERT_EQ(back.pdf(v), density.pdf(v));
        ASSERT_EQ(back.sample(v).p, density.sample(v).p);
    }
}

// Whatever the bytes are, there is an error or a density that can be used.
TEST(QuadtreeDensity, DamagedBytesAreRefusedOrHarmless) {
    ByteWriter out;
    density_of_peak(500).save(out);
    const std::vector<std::uint8_t> good = out.take();
    TestUniforms u(17);
    int refused = 0;
    for (int i = 0; i < 500; ++i) {
        std::vector<std::uint8_t> bytes = good;
        bytes[static_cast<std::size_t>(u.next() * double(bytes.size()))] ^=
            static_cast<std::uint8_t>(1 + u.next() * 255);
        if (i % 5 == 0) bytes.resize(bytes.size() / 2);
        try {
            ByteReader in(bytes);
            const QuadtreeDensity density = QuadtreeDensity::load(in);
            for (int k = 0; k < 20; ++k) density.pdf(density.sample(u.next_2f()).p);
        } catch (const Error&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 100);
}

} // namespace
} // namespace montelux
