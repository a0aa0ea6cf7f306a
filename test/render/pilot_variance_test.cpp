// Variances of pilots: that of their samples, and of the light that they missed.
#include <cmath>
#include <cstddef>
#include <functional>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/random/philox_stream.h"
#include "montelux/render/pilot_variance.h"

namespace montelux::testing {
namespace {

constexpr std::size_t tile_pixels = 64, pilot_tiles = 400;

std::vector<std::size_t> ends() {
    std::vector<std::size_t> e;
    for (std::size_t t = 1; t <= pilot_tiles; ++t) e.push_back(t * tile_pixels);
    return e;
}

PilotPart part_of(std::uint64_t seed, const std::function<double(std::size_t tile, PhiloxStream&)>& sample) {
    PilotPart part;
    PhiloxStream stream(seed);
    for (std::size_t i = 0; i < pilot_tiles * tile_pixels; ++i) {
        part.first.push_back(static_cast<float>(sample(i / tile_pixels, stream)));
        part.second.push_back(static_cast<float>(sample(i / tile_pixels, stream)));
    }
    return part;
}
PilotPicture pilot_picture(std::uint64_t seed,
                           const std::function<double(std::size_t tile, PhiloxStream&)>& sample) {
    return {.parts = {part_of(seed, sample)}};
}
// Light of mean 1 that a share of the samples finds: variance 1 / share - 1.
PilotPicture found_by(std::uint64_t seed, double share) {
    return pilot_picture(seed, [share](std::size_t, PhiloxStream& s) {
        return double(s.next_1d()) < share ? 1 / share : 0.0;
    });
}

TEST(PilotVariance, IsThatOfASample) {
    for (const PilotMeasure measure : {PilotMeasure::pixels, PilotMeasure::picture}) {
        const std::vector<PilotPicture> pictures{found_by(1, 0.5), found_by(2, 0.1)};
        const std::vector<double> v = relative_variances(pictures, ends(), measure);
        EXPECT_NEAR(v[0], 1, 0.08);
        EXPECT_NEAR(v[1], 9, 0.7);
    }
}

// Of estimates that stand for several samples each, of parts that add up, and of light paths from a share of the picture.
TEST(PilotVariance, CountsSamplesAndParts) {
    PilotPicture groups = found_by(3, 0.5), two = found_by(4, 0.5);
    groups.parts[0].samples = 8;
    two.parts.push_back(part_of(5, [](std::size_t, PhiloxStream&) { return 0.0; }));
    PilotPart splats = found_by(6, 0.5).parts[0];
    splats.samples = 0.25;
    two.parts[1] = splats; // mean 2 in all, variance of a sample 1 + 0.25
    const std::vector<double> g = relative_variances(std::vector{groups}, ends(), PilotMeasure::picture);
    const std::vector<double> t = relative_variances(std::vector{two}, ends(), PilotMeasure::picture);
    EXPECT_NEAR(g[0], 8, 0.3);
    EXPECT_NEAR(t[0], 1.25 / 4, 0.015);
}

// Two samples of a method that finds a caustic once in a million times report no variance.
TEST(PilotVariance, ShowsLightThatOneMissed) {
    const auto dim = [](std::size_t, PhiloxStream& s) { return 0.5 + double(s.next_1d()); };
    const PilotPicture misses = pilot_picture(7, dim);
    const PilotPicture finds = pilot_picture(8, [&](std::size_t tile, PhiloxStream& s) {
        return dim(tile, s) + (tile % 4 == 0 ? 4 * double(s.next_1d()) : 0.0);
    });
    const std::vector<double> alone = relative_variances(std::vector{misses}, ends(), PilotMeasure::pixels);
    EXPECT_NEAR(alone[0], 1.0 / 12, 0.01);
    const std::vector<double> v =
        relative_variances(std::vector{misses, finds}, ends(), PilotMeasure::pixels);
    // L = 2 in a quarter of the tiles of mean 3, less three errors: 128 (2 - 0.4)^2 / 3^2 / 4 at least.
    EXPECT_GT(v[0], 9);
    EXPECT_LT(v[1], 1);
    // Chains are no evidence: their errors are not well known.
    std::vector<PilotPicture> chains{misses, finds};
    chains[1].is_evidence = false;
    EXPECT_LT(relative_variances(chains, ends(), PilotMeasure::pixels)[0], 1);
}

// Fireflies raise a mean and its error: the method without them does not miss light.
TEST(PilotVariance, FirefliesAreNoEvidence) {
    const std::vector<PilotPicture> pictures{found_by(9, 0.9), found_by(10, 1.0 / 2000)};
    for (const PilotMeasure measure : {PilotMeasure::pixels, PilotMeasure::picture}) {
        const std::vector<double> v = relative_variances(pictures, ends(), measure);
        EXPECT_LT(v[0], 0.2);
        EXPECT_GT(v[1], 1000);
    }
}

// Neighbouring pixels that light reaches together: the errors of means over tiles are larger than those of pixels tell.
TEST(PilotVariance, KnowsCorrelatedPixels) {
    const auto shared = [](std::uint64_t seed) {
        PilotPart part;
        PhiloxStream stream(seed);
        for (std::size_t t = 0; t < pilot_tiles; ++t) {
            double a = 0, b = 0;
            for (std::size_t i = 0; i < tile_pixels; ++i) {
                if (i % 4 == 0) a = double(stream.next_1d()), b = double(stream.next_1d());
                part.first.push_back(static_cast<float>(0.5 + a));
                part.second.push_back(static_cast<float>(0.5 + b));
            }
        }
        return part;
    };
    const PilotPicture exact = pilot_picture(11, [](std::size_t, PhiloxStream&) { return 1.0; });
    const std::vector<double> v = relative_variances(std::vector{exact, PilotPicture{.parts = {shared(12)}}},
                                                     ends(), PilotMeasure::picture);
    EXPECT_LT(v[0], 0.002);
    EXPECT_NEAR(v[1], 1.0 / 12, 0.01);
}

TEST(PilotVariance, IsZeroInTheDark) {
    const auto dark = [](std::size_t, PhiloxStream&) { return 0.0; };
    const std::vector<double> v = relative_variances(
        std::vector{pilot_picture(1, dark), pilot_picture(2, dark)}, ends(), PilotMeasure::pixels);
    EXPECT_EQ(v[0], 0);
    EXPECT_EQ(v[1], 0);
}

} // namespace
} // namespace montelux::testing
