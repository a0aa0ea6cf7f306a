#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "montelux/film/film.h"
#include "montelux/film/film_error.h"
#include "montelux/film/pixel_warnings.h"
#include "montelux/mc/random/philox_stream.h"

namespace montelux {
namespace {

constexpr double no_evidence = std::numeric_limits<double>::quiet_NaN();

std::vector<PixelWarning> warnings_of(std::vector<double> variances, int width) {
    std::vector<PixelSpread> spreads;
    for (double v : variances) spreads.push_back({v, false});
    return pixel_warnings(spreads, width);
}

TEST(PixelWarnings, AreHeldAgainstThoseAround) {
    using enum PixelWarning;
    // The mean of the three around a corner is 3, not more; then 10/3. That of the five around the middle of
    // a side is 12/5.
    EXPECT_EQ(warnings_of({1, 1, 1, 1, 7, 1, 1, 1, 1}, 3), std::vector<PixelWarning>(9, none));
    const std::vector<PixelWarning> corners = warnings_of({1, 1, 1, 1, 8, 1, 1, 1, 1}, 3);
    EXPECT_EQ(corners, (std::vector<PixelWarning>{neighbours, none, neighbours, none, none, none, neighbours,
                                                  none, neighbours}));
}

TEST(PixelWarnings, RowsAreNotJoinedAtTheirEnds) {
    using enum PixelWarning;
    EXPECT_EQ(warnings_of({1, 1, 1, 50, 1, 1, 1, 1}, 8),
              (std::vector<PixelWarning>{none, none, neighbours, none, neighbours, none, none, none}));
    // The end of the first row and the beginning of the second are no neighbours.
    EXPECT_EQ(warnings_of({1, 1, 1, 50, 50, 50, 1, 1, 1, 1, 1, 1}, 4)[3], none);
    EXPECT_EQ(warnings_of({1, 1, 1, 50, 1, 1, 1, 50}, 4),
              (std::vector<PixelWarning>{none, none, neighbours, none, none, none, neighbours, none}));
}

TEST(PixelWarnings, ErrorsThatAreNotKnownSayNothing) {
    using enum PixelWarning;
    EXPECT_EQ(warnings_of({no_evidence, 100, no_evidence}, 3),
              (std::vector<PixelWarning>{unknown, none, unknown}));
    EXPECT_EQ(warnings_of({1, no_evidence, 3.5}, 3), (std::vector<PixelWarning>{none, unknown, none}));
    EXPECT_EQ(warnings_of({7}, 1), std::vector<PixelWarning>(1, PixelWarning::none));
    EXPECT_TRUE(std::isnan(pixel_spread(2, 15, 15, 0.9).variance));
    EXPECT_FALSE(pixel_spread(2, 15, 15, 0.9).bright_replicate);
    EXPECT_EQ(pixel_spread(2, 16, 16, 0.9).variance, 64);
    EXPECT_TRUE(pixel_spread(2, 16, 16, 0.9).bright_replicate);
    EXPECT_FALSE(pixel_spread(2, 16, 16, 0.49).bright_replicate);
}

// Pixels with too few replicates must not look like reliable ones.
TEST(PixelWarnings, TooFewReplicatesAreReported) {
    Film film({.width = 2, .height = 1, .crop = {0, 0, 2, 1}});
    PhiloxStream random(3);
    for (int x = 0; x < 2; ++x)
        for (int k = 0; k < 15 + x; ++k) {
            const auto v = static_cast<float>(random.next_double());
            film.pixel(x, 0).add_sample({.radiance = {v, v, v}, .albedo = {}, .normal = {}});
            film.pixel(x, 0).end_replicate();
        }
    EXPECT_EQ(static_cast<int>(pixel_warnings(film)[0]), 3);
    EXPECT_EQ(static_cast<int>(pixel_warnings(film)[1]), 0);
    const Image image = film.develop();
    EXPECT_EQ(image.value(0, 0, *image.find_channel("warning")), 3);
    EXPECT_EQ(outliers_of(film).unknown, 1u);
    EXPECT_EQ(outliers_of(film).pixels, 2u);
}

// On the left all samples see the whole light, on the right one in 150 hits most of it: a sixth of the
// pixels there never do in 256 samples, and are far too sure. The bounds are five standard deviations away
// from what many seeds give.
TEST(PixelWarnings, TheOthersErrorsHold) {
    constexpr int width = 128, height = 64, samples = 256;
    constexpr double rare = 1.0 / 150, bright = 60;
    Film film({.width = width, .height = height, .crop = {0, 0, width, height}});
    PhiloxStream random(7);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int k = 0; k < samples; ++k) {
                const double base = random.next_double(), chance = random.next_double();
                const auto value = static_cast<float>(base + (x >= width / 2 && chance < rare ? bright : 0));
                film.pixel(x, y).add_sample({.radiance = {value, value, value}, .albedo = {}, .normal = {}});
                film.pixel(x, y).end_replicate();
            }
    const std::vector<PixelWarning> warnings = pixel_warnings(film);
    struct Side {
        double sure = 0, sure_covered = 0, not_bright = 0, not_bright_covered = 0;
    } sides[2];
    std::size_t i = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x, ++i) {
            const bool right = x >= width / 2;
            if (x == width / 2 || x == width / 2 - 1) continue;
            const Pixel& p = film.pixel(x, y);
            const double truth = 0.5 + (right ? rare * bright : 0);
            const bool covered = std::abs(p.replicates().mean(0) - truth) <= 2 * luminance_error(p);
            Side& side = sides[right];
            if (warnings[i] != PixelWarning::bright_replicate) {
                ++side.not_bright;
                side.not_bright_covered += covered;
            }
            if (warnings[i] == PixelWarning::none) {
                ++side.sure;
                side.sure_covered += covered;
            }
        }
    const auto& [left, right] = sides;
    EXPECT_GT(left.sure / (height * (width / 2 - 1)), 0.999);
    EXPECT_NEAR(left.sure_covered / left.sure, 0.954, 0.017);
    EXPECT_LT(right.not_bright_covered / right.not_bright, 0.8);
    EXPECT_GT(right.sure_covered / right.sure, 0.93) << right.sure;
    EXPECT_GT(right.sure, 0.4 * height * (width / 2 - 1));
}

} // namespace
} // namespace montelux
