// Sample indices of each pixel, and the sample counts of the next round.
#include "test/render/mixed_scene.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>
#include <set>

#include "montelux/mc/math/error.h"
#include "montelux/mc/random/hash.h"
#include "montelux/render/sample_allocation.h"

namespace montelux::testing {
namespace {

TEST(SampleOrder, SlicesShareTheSamples) {
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol})
        for (std::uint32_t spp : {1u, 7u, 64u, 100u})
            for (std::uint32_t slices : {1u, 3u, 16u}) {
                const SamplerSettings s = with_replicates({kind, 0, spp}, {});
                std::multiset<std::uint64_t> taken;
                std::set<std::uint64_t> replicates;
                for (std::uint32_t k = 0; k < slices; ++k) {
                    const SampleOrder order(s, {k, slices});
                    for (std::uint64_t i = 0; i < order.share(); ++i) {
                        taken.insert(order.index(i));
                        // A replicate is whole in one slice.
                        if (i % order.replicate_size() == 0) {
                            EXPECT_TRUE(replicates.insert(order.index(i) / order.replicate_size()).second);
                        }
                    }
                }
                ASSERT_EQ(taken.size(), spp) << slices;
                std::uint64_t expected = 0;
                for (std::uint64_t index : taken) EXPECT_EQ(index, expected++);
            }
}

TEST(SampleAllocation, EqualOnesCoverAllSamplesAndEndWithReplicates) {
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::stratified, SamplerKind::sobol})
        for (std::uint32_t spp : {1u, 2u, 7u, 8u, 64u, 100u, 1000u}) {
            const SamplerSettings s = with_replicates({kind, 0, spp, 1}, {});
            if (kind != SamplerKind::independent && spp > 1) {
                EXPECT_GE(s.replicates, 2u);
            }
            RenderState state({.width = 1, .height = 1, .crop = {0, 0, 1, 1}});
            const SampleOrder order(s, {});
            std::uint64_t at = 0;
            for (;;) {
                const std::vector<std::uint32_t> target_samples = next_target_samples(state, s, {});
                if (target_samples.empty()) break;
                ASSERT_GT(target_samples[0], at);
                EXPECT_LE(target_samples[0] - at, 16u);
                // None spans two replicates of several samples.
                if (order.replicate_size() > 1) {
                    EXPECT_EQ(at / order.replicate_size(), (target_samples[0] - 1) / order.replicate_size());
                }
                at = target_samples[0];
                state.target_samples = target_samples;
            }
            EXPECT_EQ(at, spp);
        }
    EXPECT_EQ(with_replicates({SamplerKind::sobol, 0, 64, 3}, {}).replicates, 3u);
    EXPECT_EQ(points_per_replicate(with_replicates({SamplerKind::sobol, 0, 1 << 20, 1}, {.error = 0.01})),
              8u);
}

// A pilot that took all its samples tile by tile would leave most of a picture black when it is interrupted.
TEST(SampleAllocation, PilotsBeginWithOneSampleOfEachPixel) {
    for (const SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol})
        for (const double time : {0.0, 100.0}) {
            const RenderTarget target{.error = 0.01, .time = time, .adaptive = true};
            const SamplerSettings s = with_replicates({kind, 0, 1u << 20}, target);
            const std::uint64_t pilot = pilot_of(SampleOrder(s, {}));
            RenderState state({.width = 1, .height = 1, .crop = {0, 0, 1, 1}});
            std::vector<std::uint32_t> counts;
            while (counts.empty() || counts.back() < pilot) {
                state.target_samples = next_target_samples(state, s, target);
                ASSERT_FALSE(state.target_samples.empty());
                counts.push_back(state.target_samples[0]);
            }
            ASSERT_GE(counts.size(), 5u);
            EXPECT_EQ(std::vector<std::uint32_t>(counts.begin(), counts.begin() + 4),
                      (std::vector<std::uint32_t>{1, 2, 4, 8}));
            EXPECT_EQ(counts.back(), pilot);
        }
}

// Pixels with n replicates whose values have the given standard deviation.
Film film_with(const std::vector<double>& deviations, int width, int n, std::uint64_t seed) {
    const int height = static_cast<int>(deviations.size()) / width;
    Film film({.width = width, .height = height, .crop = {0, 0, width, height}});
    std::size_t i = 0;
    for (Pixel& p : film.pixels()) {
        for (int k = 0; k < n; ++k) {
            const std::uint64_t bits = hash_key(seed, i, k);
            const float v = static_cast<float>(10 + deviations[i] * ((bits & 1u) != 0 ? 1 : -1));
            p.add_sample({.radiance = {v, v, v}, .albedo = {}, .normal = {}});
            p.end_replicate();
        }
        ++i;
    }
    return film;
}
double sum(const std::vector<std::uint32_t>& target_samples) {
    return std::accumulate(target_samples.begin(), target_samples.end(), 0.0);
}

TEST(NeymanAllocation, FollowsTheDeviationsAndStarvesNobody) {
    constexpr int width = 64;
    std::vector<double> deviations(width * width, 0.0);
    for (std::size_t i = 0; i < deviations.size(); ++i)
        deviations[i] = i % width < 16 ? 0 : i % width < 48 ? 1 : 2;
    const Film film = film_with(deviations, width, 64, 1);
    SamplerSettings s{SamplerKind::independent, 0, 1u << 20};
    const std::vector<std::uint32_t> target_samples =
        neyman_allocation(film, SampleOrder(s, {}), {.error = 1e-9});
    ASSERT_EQ(target_samples.size(), deviations.size());
    EXPECT_NEAR(sum(target_samples), 2 * 64.0 * width * width, 0.01 * sum(target_samples));
    auto at = [&](int x) { return target_samples[static_cast<std::size_t>(32 * width + x)]; };
    EXPECT_EQ(at(4), 64u); // has more than its third of the mean
    EXPECT_NEAR(at(56) / static_cast<double>(at(32)), 2, 0.4);
    // Further on every pixel gets its third.
    const Film later = film_with(deviations, width, 4, 1);
    const std::vector<std::uint32_t> few = neyman_allocation(later, SampleOrder(s, {}), {});
    EXPECT_GE(few[32 * width + 4], 0.2 * sum(few) / (width * width));
}

// The pixel's own samples have no part in it.
TEST(NeymanAllocation, DoesNotDependOnThePixelItself) {
    constexpr int width = 9;
    const std::vector<double> even(width * width, 1.0);
    std::vector<double> spot = even;
    spot[4 * width + 4] = 1.7;
    SamplerSettings s{SamplerKind::independent, 0, 1u << 20};
    const SampleOrder order(s, {});
    // Scaled so that the pixels around may get more, but its own weight stays.
    const auto a = neyman_allocation(film_with(even, width, 1024, 3), order, {.error = 1e-9});
    const auto b = neyman_allocation(film_with(spot, width, 1024, 3), order, {.error = 1e-9});
    EXPECT_LT(b[4 * width + 4], a[4 * width + 4]);
    EXPECT_GT(b[4 * width + 5], a[4 * width + 5]);
}

TEST(NeymanAllocation, GoesAsFarAsTheTargetNeedsInWholeReplicates) {
    constexpr int width = 32;
    const Film film = film_with(std::vector<double>(width * width, 1.0), width, 64, 5);
    SamplerSettings s{SamplerKind::sobol, 0, 1u << 20, 1, 8};
    // Relative error now: 1 / sqrt(64) / 10 = 1.25 %; for 1.05 % about 90.7 samples are needed.
    const auto target_samples = neyman_allocation(film, SampleOrder(s, {}), {.error = 0.0105});
    for (std::uint32_t g : target_samples) EXPECT_EQ(g % 8, 0u);
    EXPECT_NEAR(sum(target_samples) / (width * width), 90.7, 8);
    // At most twice as many, at least a tenth more, and never more than there are.
    EXPECT_LE(sum(neyman_allocation(film, SampleOrder(s, {}), {.error = 1e-4})), 128.01 * width * width);
    EXPECT_GT(sum(neyman_allocation(film, SampleOrder(s, {}), {.error = 0.5})), 64.0 * width * width);
    s.spp = 80;
    EXPECT_LE(sum(neyman_allocation(film, SampleOrder(s, {}), {.error = 1e-4})), 80.0 * width * width);
    s.spp = 64;
    EXPECT_TRUE(neyman_allocation(film, SampleOrder(s, {}), {.error = 1e-4}).empty());
}

// A quantile that few samples meet: the pixels that lack samples get just these, and no other pixel any.
TEST(SampleAllocation, QuantilesThatAreMetGetTheSamplesToTrustThem) {
    constexpr int width = 8;
    const RenderTarget target{.error = 0.05, .quantile = 0.9, .adaptive = true};
    const SamplerSettings s{SamplerKind::sobol, 0, 1u << 20, 1, 8};
    const auto next = [&](int samples, double deviation, const SamplerSettings& sampler) {
        RenderState state({.width = width, .height = width, .crop = {0, 0, width, width}});
        state.film = film_with(std::vector<double>(width * width, deviation), width, samples, 3);
        for (int k = 0; k < 80; ++k)
            state.film.pixels()[5].add_sample({.radiance = {10, 10, 10}, .albedo = {}, .normal = {}});
        state.target_samples.assign(width * width, static_cast<std::uint32_t>(samples));
        return next_target_samples(state, sampler, target);
    };
    const std::vector<std::uint32_t> met = next(32, 0.01, s);
    for (std::size_t i = 0; i < met.size(); ++i) EXPECT_EQ(met[i], i == 5 ? 112u : 64u);
    // Not met: as the deviations have it.
    const std::vector<std::uint32_t> wanting = next(32, 9, s);
    EXPECT_GT(sum(wanting), 1.5 * 32 * width * width);
    // More than may be taken.
    SamplerSettings few = s;
    few.spp = 48;
    EXPECT_LE(sum(next(32, 0.01, few)), 48.0 * width * width);
}

TEST(NeymanAllocation, BlackPicturesAndSinglePixelsContinue) {
    SamplerSettings s{SamplerKind::independent, 0, 1u << 20};
    Film black({.width = 4, .height = 4, .crop = {0, 0, 4, 4}});
    for (Pixel& p : black.pixels())
        for (int i = 0; i < 16; ++i) {
            p.add_sample({});
            p.end_replicate();
        }
    const auto target_samples = neyman_allocation(black, SampleOrder(s, {}), {.error = 0.01});
    ASSERT_EQ(target_samples.size(), 16u);
    EXPECT_GT(target_samples[0], 16u);
    const auto one = neyman_allocation(film_with({1.0}, 1, 16, 1), SampleOrder(s, {}), {.error = 1e-3});
    ASSERT_EQ(one.size(), 1u);
    EXPECT_EQ(one[0], 32u);
}

} // namespace
} // namespace montelux::testing
