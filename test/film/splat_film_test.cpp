// Splats: sums of contributions in fixed point, whatever the order, and replicates of whole passes.
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <thread>
#include <vector>

#include "montelux/film/film.h"
#include "montelux/film/splat_film.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

constexpr PixelBounds bounds{3, 2, 7, 5};

// A contribution of any size: magnitudes from 2^-40 to 2^20, some negative.
Vec3d contribution(std::uint64_t i) {
    Vec3d rgb;
    for (int c = 0; c < 3; ++c) {
        const std::uint64_t h = hash_key(i, static_cast<std::uint64_t>(c));
        const double mantissa = static_cast<double>(h >> 40) * 0x1p-24 - 0.1;
        rgb[c] = std::ldexp(mantissa, static_cast<int>(h % 61) - 40);
    }
    return rgb;
}
int column(std::uint64_t i) { return bounds.x0 + static_cast<int>(i % 4); }
int row(std::uint64_t i) { return bounds.y0 + static_cast<int>(i / 4 % 3); }

std::vector<std::int64_t> copy_of(const SplatFilm& film) { return {film.sums().begin(), film.sums().end()}; }

TEST(SplatFilm, SumsAreExactToTheirUnit) {
    SplatFilm film(bounds);
    const std::vector<double> values{1, 0.1, 1e-9, 3e-13, 123456.789, -0.25, 1e-9};
    double expected = 0;
    for (const double v : values) {
        EXPECT_TRUE(film.add(4, 3, {v, 2 * v, 0}));
        expected += v;
    }
    EXPECT_NEAR(film.sum(4, 3).x, expected, 7 * 0x1p-49 + 1e-10 * 0x1p-10);
    EXPECT_NEAR(film.sum(4, 3).y, 2 * expected, 7 * 0x1p-49 + 1e-10 * 0x1p-10);
    EXPECT_EQ(film.sum(4, 3).z, 0);
    EXPECT_EQ(film.sum(3, 4), Vec3d());
}

// A million tiny contributions beside a great one are not lost.
TEST(SplatFilm, SmallContributionsSurviveBesideGreatOnes) {
    SplatFilm film(bounds);
    film.add(3, 2, {0x1p30, 0x1p30, 0});
    for (int i = 0; i < 1000000; ++i) film.add(3, 2, {1e-10, 0x1p-48, 0});
    EXPECT_NEAR(film.sum(3, 2).x - 0x1p30, 1e-4, 4e-7); // doubles at 2^30 have steps of 2.4e-7
    EXPECT_EQ(film.sums()[3], 1000000);
}

TEST(SplatFilm, AnyOrderAndAnyThreadsGiveTheSameBits) {
    constexpr std::uint64_t n = 20000;
    SplatFilm forwards(bounds), backwards(bounds), threads(bounds), halves(bounds), other(bounds);
    for (std::uint64_t i = 0; i < n; ++i) forwards.add(column(i), row(i), contribution(i));
    for (std::uint64_t i = n; i-- > 0;) backwards.add(column(i), row(i), contribution(i));
    parallel_for(n, [&](std::int64_t i) {
        const auto k = static_cast<std::uint64_t>(i);
        threads.add(column(k), row(k), contribution(k));
    });
    for (std::uint64_t i = 0; i < n; ++i)
        (i % 3 == 0 ? halves : other).add(column(i), row(i), contribution(i));
    halves.merge(other);
    EXPECT_EQ(copy_of(forwards), copy_of(backwards));
    EXPECT_EQ(copy_of(forwards), copy_of(threads));
    EXPECT_EQ(copy_of(forwards), copy_of(halves));
    EXPECT_NE(copy_of(forwards), copy_of(other));
}

TEST(SplatFilm, ThreadsThatMeetAtOnePixelLoseNothing) {
    SplatFilm film(bounds);
    constexpr int each = 200000, count = 4;
    {
        std::vector<std::jthread> threads;
        for (int t = 0; t < count; ++t)
            threads.emplace_back([&film] {
                for (int i = 0; i < each; ++i) film.add(3, 2, {1, 2, 3});
            });
    }
    for (int c = 0; c < 3; ++c) EXPECT_EQ(film.sum(3, 2)[c], (c + 1.0) * each * count);
}

TEST(SplatFilm, PixelsOutsideAreIgnored) {
    SplatFilm film(bounds);
    for (const auto& [x, y] : {std::pair{2, 3}, {7, 3}, {4, 1}, {4, 5}})
        EXPECT_TRUE(film.add(x, y, {1, 1, 1}));
    EXPECT_EQ(copy_of(film), copy_of(SplatFilm(bounds)));
    film.add(6, 4, {1, 1, 1});
    EXPECT_EQ(film.sum(6, 4), (Vec3d{1, 1, 1}));
}

TEST(SplatFilm, BadContributionsAreLeftOutAndCounted) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                     inf = std::numeric_limits<double>::infinity();
    SplatFilm film(bounds);
    EXPECT_FALSE(film.add(4, 3, {1, nan, 1}));
    EXPECT_FALSE(film.add(4, 3, {1, 1, -inf}));
    EXPECT_FALSE(film.add(4, 3, {2 * SplatFilm::most, 1, 1}));
    EXPECT_TRUE(film.add(4, 3, {SplatFilm::most, 0, 0}));
    EXPECT_EQ(film.bad(), 3u);
    EXPECT_EQ(film.overflows(), 0u);
    EXPECT_EQ(film.sum(4, 3), (Vec3d{SplatFilm::most, 0, 0}));
    film.clear();
    EXPECT_EQ(film.bad(), 0u);
    EXPECT_EQ(film.sum(4, 3), Vec3d());
}

TEST(SplatFilm, OverflowIsCounted) {
    SplatFilm film(bounds);
    for (int i = 0; i < (1 << 17); ++i) film.add(3, 2, {SplatFilm::most, 0, -SplatFilm::most});
    EXPECT_EQ(film.overflows(), 1u); // 2^63 does not fit, -2^63 does
    SplatFilm half(bounds), whole(bounds);
    for (int i = 0; i < (1 << 16); ++i) half.add(3, 2, {SplatFilm::most, 0, 0});
    whole.merge(half);
    EXPECT_EQ(whole.overflows(), 0u);
    whole.merge(half);
    EXPECT_EQ(whole.overflows(), 1u);
    EXPECT_THROW(whole.merge(SplatFilm({0, 0, 1, 1})), Error);
    EXPECT_THROW(SplatFilm({4, 4, 4, 6}), Error);
}

// A pass: its samples' mean plus what light paths brought.
TEST(SplatFilm, PassesAreReplicates) {
    Pixel p, whole;
    for (const double splats : {0.5, 1.5}) {
        for (const float v : {1.0f, 2.0f, 6.0f})
            p.add_sample({.radiance = {v, v, v}, .albedo = {}, .normal = {}});
        p.add_splats({splats, 0, 0});
        p.end_replicate();
        whole.add_replicate({3 + splats, 3, 3}, 3);
    }
    for (const Pixel* pixel : {&p, &whole}) {
        EXPECT_EQ(pixel->samples(), 6u);
        EXPECT_EQ(pixel->open_samples(), 0u);
        EXPECT_EQ(pixel->replicates().count(), 2u);
        EXPECT_DOUBLE_EQ(pixel->replicates().mean(0), 4);
        EXPECT_DOUBLE_EQ(pixel->replicates().mean(1), 3);
        EXPECT_DOUBLE_EQ(pixel->replicates().standard_error(0), 0.5);
        EXPECT_DOUBLE_EQ(pixel->brightest().x, 4.5);
    }
    p.add_sample({.radiance = {9, 9, 9}, .albedo = {}, .normal = {}});
    p.drop_replicate();
    p.end_replicate();
    EXPECT_EQ(p.replicates().count(), 2u);
}

} // namespace
} // namespace montelux
