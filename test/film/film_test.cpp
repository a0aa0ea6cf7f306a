// The film's bookkeeping: replicates, bad samples, the error of the whole picture, and its layers.
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "montelux/film/film.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

FilmSettings settings(int width, int height, PixelBounds crop) {
    FilmSettings s;
    s.width = width;
    s.height = height;
    s.crop = crop;
    return s;
}

FilmSample gray_sample(float v) { return {.radiance = {v, v, v}, .albedo = {}, .normal = {}}; }

TEST(Pixel, EverySampleAReplicate) {
    Pixel p;
    for (float v : {1.0f, 2.0f, 6.0f}) {
        p.add_sample(gray_sample(v));
        p.end_replicate();
    }
    EXPECT_EQ(p.samples(), 3u);
    EXPECT_EQ(p.replicates().count(), 3u);
    EXPECT_DOUBLE_EQ(p.replicates().mean(1), 3);
    EXPECT_DOUBLE_EQ(p.replicates().standard_error(1), std::sqrt(7.0 / 3));
}

// The error of replicates comes from their means: the spread within one is not noise.
TEST(Pixel, AReplicateOfAPointSet) {
    Pixel p;
    for (float offset : {0.0f, 0.5f}) {
        for (float v : {1.0f, 9.0f, 2.0f, 8.0f}) p.add_sample(gray_sample(v + offset));
        p.end_replicate();
    }
    EXPECT_EQ(p.samples(), 8u);
    EXPECT_EQ(p.replicates().count(), 2u);
    EXPECT_DOUBLE_EQ(p.replicates().mean(0), 5.25);
    EXPECT_DOUBLE_EQ(p.replicates().standard_error(0), 0.25);
}

TEST(Pixel, AnEmptyReplicateIsNone) {
    Pixel p;
    p.end_replicate();
    p.add_sample(gray_sample(4));
    p.end_replicate();
    p.end_replicate();
    EXPECT_EQ(p.replicates().count(), 1u);
    EXPECT_DOUBLE_EQ(p.replicates().mean(), 4);
    EXPECT_TRUE(std::isinf(p.replicates().standard_error()));
}

// A bad sample is left out of the sum, not out of the count: its pixel is darker, and says why.
TEST(Pixel, BadSamplesCountAsZeros) {
    Pixel p;
    p.add_sample(gray_sample(6));
    p.count_bad();
    p.add_sample(gray_sample(6));
    p.end_replicate();
    p.count_bad();
    p.end_replicate();
    EXPECT_EQ(p.samples(), 4u);
    EXPECT_EQ(p.bad(), 2u);
    EXPECT_EQ(p.replicates().count(), 2u);
    EXPECT_DOUBLE_EQ(p.replicates().mean(), 2); // of 4 and 0
}

TEST(Pixel, FirstSurfaceIsTheMeanOverSamples) {
    Pixel p;
    p.add_sample({.radiance = {}, .albedo = {0.2f, 0.4f, 0.6f}, .normal = {0, 0, 1}, .depth = 3});
    p.add_sample({.radiance = {}, .albedo = {0.4f, 0, 0.2f}, .normal = {0, 1, 0}, .depth = 5});
    p.add_sample(gray_sample(1));
    p.count_bad();
    EXPECT_FLOAT_EQ(p.albedo().x, 0.15f);
    EXPECT_FLOAT_EQ(p.albedo().z, 0.2f);
    EXPECT_FLOAT_EQ(p.normal().y, 0.25f);
    EXPECT_FLOAT_EQ(p.depth(), 2);
    EXPECT_EQ(Pixel().albedo().x, 0);
    EXPECT_EQ(Pixel().depth(), 0);
}

// A whole replicate of four samples and the beginning of one would else weigh the same.
TEST(Pixel, ShortLastReplicatesAreLeftOutWhereThereAreOthers) {
    for (int open : {1, 2, 3}) {
        Pixel p;
        for (int replicate = 0; replicate < 2; ++replicate) {
            for (int i = 0; i < 4; ++i) p.add_sample(gray_sample(1));
            p.end_replicate();
        }
        for (int i = 0; i < open; ++i) p.add_sample(gray_sample(7));
        p.end_last_replicate(4);
        EXPECT_EQ(p.replicates().count(), open >= 2 ? 3u : 2u);
        EXPECT_DOUBLE_EQ(p.replicates().mean(), open >= 2 ? 3 : 1);
        p.end_replicate(); // nothing is left
        EXPECT_EQ(p.replicates().count(), open >= 2 ? 3u : 2u);
    }
    Pixel alone;
    alone.add_sample(gray_sample(5));
    alone.end_last_replicate(4);
    EXPECT_EQ(alone.replicates().count(), 1u);
}

TEST(Film, ErrorOfThePicture) {
    Film film(settings(2, 1, {0, 0, 2, 1}));
    // Luminances 2 +- 0.5 and 4 +- 1.
    for (float d : {-0.5f, 0.5f}) {
        film.pixel(0, 0).add_sample(gray_sample(2 + d));
        film.pixel(0, 0).end_replicate();
        film.pixel(1, 0).add_sample(gray_sample(4 + 2 * d));
        film.pixel(1, 0).end_replicate();
    }
    FilmError e = film.error();
    EXPECT_NEAR(e.mean_luminance, 3, 1e-12);
    EXPECT_EQ(e.mean_samples, 2);
    EXPECT_NEAR(e.relative, std::sqrt((0.25 + 1) / 2) / 3, 1e-12);
}

// Luminance weights are those of linear sRGB.
TEST(Film, ErrorWeighsTheChannels) {
    const double weights[] = {0.2126, 0.7152, 0.0722};
    for (int c = 0; c < 3; ++c) {
        Film film(settings(1, 1, {0, 0, 1, 1}));
        for (float v : {1.0f, 3.0f}) {
            FilmSample s = gray_sample(0);
            s.radiance[c] = v;
            film.pixel(0, 0).add_sample(s);
            film.pixel(0, 0).end_replicate();
        }
        EXPECT_NEAR(film.error().mean_luminance, 2 * weights[c], 1e-12);
        EXPECT_NEAR(film.error().relative, 0.5, 1e-12);
    }
}

TEST(Film, ErrorOfBlackAndUnknown) {
    Film black(settings(1, 1, {0, 0, 1, 1}));
    for (int i = 0; i < 4; ++i) {
        black.pixel(0, 0).add_sample(gray_sample(0));
        black.pixel(0, 0).end_replicate();
    }
    EXPECT_EQ(black.error().relative, 0);
    Film once(settings(1, 1, {0, 0, 1, 1}));
    once.pixel(0, 0).add_sample(gray_sample(1));
    once.pixel(0, 0).end_replicate();
    EXPECT_TRUE(std::isinf(once.error().relative));
    Film black_once(settings(1, 1, {0, 0, 1, 1}));
    black_once.pixel(0, 0).add_sample(gray_sample(0));
    black_once.pixel(0, 0).end_replicate();
    EXPECT_TRUE(std::isinf(black_once.error().relative));
}

TEST(Film, DevelopsTheCropWithItsLayers) {
    Film film(settings(10, 8, {3, 2, 6, 4}));
    for (int y = 2; y < 4; ++y)
        for (int x = 3; x < 6; ++x)
            for (float d : {-1.0f, 1.0f}) {
                auto fx = static_cast<float>(x), fy = static_cast<float>(y);
                film.pixel(x, y).add_sample({.radiance = {fx + d, fy + 2 * d, 7 + 3 * d},
                                             .albedo = {0.1f * fx, 0.2f, 0.3f},
                                             .normal = {0, 0.5f, 0.1f * fy},
                                             .depth = fx * fy});
                film.pixel(x, y).end_replicate();
            }
    Image image = film.develop();
    ASSERT_EQ(image.width(), 3);
    ASSERT_EQ(image.height(), 2);
    auto value = [&](const char* channel, int x, int y) {
        auto c = image.find_channel(channel);
        if (!c) ADD_FAILURE() << "no channel " << channel;
        return c ? image.value(x, y, *c) : 0;
    };
    EXPECT_EQ(image.channels(), 20);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 3; ++x) {
            EXPECT_EQ(value("R", x, y), static_cast<float>(x + 3));
            EXPECT_EQ(value("G", x, y), static_cast<float>(y + 2));
            EXPECT_EQ(value("B", x, y), 7);
            // Two replicates at +-d have standard error d.
            EXPECT_EQ(value("stderr.R", x, y), 1);
            EXPECT_EQ(value("stderr.G", x, y), 2);
            EXPECT_EQ(value("stderr.B", x, y), 3);
            EXPECT_EQ(value("samples", x, y), 2);
            EXPECT_EQ(value("replicates", x, y), 2);
            EXPECT_FLOAT_EQ(value("outlier", x, y), 0.5f);
            EXPECT_EQ(value("warning", x, y), 3); // two replicates are too few to decide
            EXPECT_FLOAT_EQ(value("albedo.R", x, y), 0.1f * static_cast<float>(x + 3));
            EXPECT_FLOAT_EQ(value("albedo.B", x, y), 0.3f);
            EXPECT_FLOAT_EQ(value("N.Y", x, y), 0.5f);
            EXPECT_FLOAT_EQ(value("N.Z", x, y), 0.1f * static_cast<float>(y + 2));
            EXPECT_EQ(value("depth.Z", x, y), static_cast<float>((x + 3) * (y + 2)));
        }
    EXPECT_EQ(image.color_channels("stderr.").size(), 3u);
}

TEST(Film, ReportsTheSkewnessOfTheMean) {
    Film film(settings(1, 1, {0, 0, 1, 1}));
    // 0, 0, 0, 4: deviations -1, -1, -1, 3; m2 = 3, m3 = 6.
    for (float v : {0.0f, 0.0f, 4.0f, 0.0f}) {
        film.pixel(0, 0).add_sample(gray_sample(v));
        film.pixel(0, 0).end_replicate();
    }
    Image image = film.develop();
    auto c = image.find_channel("skewness.G");
    ASSERT_TRUE(c.has_value());
    EXPECT_NEAR(image.value(0, 0, *c), 6 / std::pow(3, 1.5) / 2, 1e-6);
}

TEST(Film, EndsReplicatesThatWereCutShort) {
    Film film(settings(2, 1, {0, 0, 2, 1}));
    film.pixel(0, 0).add_sample(gray_sample(3));
    film.end_replicates();
    EXPECT_EQ(film.pixel(0, 0).replicates().count(), 1u);
    EXPECT_EQ(film.pixel(1, 0).replicates().count(), 0u);
}

TEST(Film, OneReplicateHasNoError) {
    Film film(settings(1, 1, {0, 0, 1, 1}));
    film.pixel(0, 0).add_sample(gray_sample(1));
    film.pixel(0, 0).end_replicate();
    Image image = film.develop();
    EXPECT_TRUE(std::isinf(image.value(0, 0, *image.find_channel("stderr.G"))));
}

TEST(Film, RefusesSizesAndCrops) {
    EXPECT_THROW(Film(settings(0, 8, {0, 0, 0, 8})), Error);
    EXPECT_THROW(Film(settings(8, Image::max_dimension + 1, {0, 0, 8, 8})), Error);
    EXPECT_THROW(Film(settings(8, 8, {0, 0, 9, 8})), Error);
    EXPECT_THROW(Film(settings(8, 8, {-1, 0, 8, 8})), Error);
    EXPECT_THROW(Film(settings(8, 8, {4, 4, 4, 8})), Error);
    EXPECT_NO_THROW(Film(settings(8, 8, {7, 7, 8, 8})));
}

} // namespace
} // namespace montelux
