#include <cmath>
#include <gtest/gtest.h>

#include "montelux/film/film.h"

namespace montelux {
namespace {

Film film_of(int width) { return Film({.width = width, .height = 1, .crop = {0, 0, width, 1}}); }
void add(Pixel& pixel, std::initializer_list<float> values) {
    for (float v : values) {
        pixel.add_sample({.radiance = {v, v, v}, .albedo = {}, .normal = {}});
        pixel.end_replicate();
    }
}

TEST(FilmError, QuantileOfThePixels) {
    Film film = film_of(4);
    // Means 10, standard errors 1, 2, 3, 4.
    for (int x = 0; x < 4; ++x) {
        const float d = static_cast<float>(x + 1);
        add(film.pixel(x, 0), {10 - d, 10 + d});
    }
    EXPECT_NEAR(error_quantile(film, 0.25), 0.1, 1e-9);
    EXPECT_NEAR(error_quantile(film, 0.5), 0.2, 1e-9);
    EXPECT_NEAR(error_quantile(film, 0.51), 0.3, 1e-9);
    EXPECT_NEAR(error_quantile(film, 0.999), 0.4, 1e-9);
    EXPECT_NEAR(luminance_error(film.pixel(2, 0)), 3, 1e-9);
}

TEST(FilmError, FreedomIsThatOfThePixelsThatCarryTheError) {
    Film film = film_of(4);
    for (int x = 0; x < 4; ++x) add(film.pixel(x, 0), {1, 3, 1, 3});
    EXPECT_NEAR(error_freedom(film), 4 * 3, 1e-9);
    add(film.pixel(1, 0), {1e6f});
    EXPECT_NEAR(error_freedom(film), 4, 1e-6);
    Film flat = film_of(2);
    for (int x = 0; x < 2; ++x) add(flat.pixel(x, 0), {2, 2});
    EXPECT_TRUE(std::isinf(error_freedom(flat)));
    Film young = film_of(2);
    add(young.pixel(0, 0), {1, 2});
    add(young.pixel(1, 0), {1});
    EXPECT_EQ(error_freedom(young), 0);
}

TEST(FilmError, ShareOfTheBrightestReplicate) {
    Pixel pixel;
    EXPECT_EQ(pixel.largest_share(), 0);
    add(pixel, {0, 0, 0, 4}); // deviations -1, -1, -1, 3
    EXPECT_NEAR(pixel.largest_share(), 9.0 / 12, 1e-12);
    Pixel constant;
    add(constant, {2, 2, 2});
    EXPECT_EQ(constant.largest_share(), 0);
    Pixel dark_outlier; // the brightest is what counts
    add(dark_outlier, {4, 4, 4, 0});
    EXPECT_NEAR(dark_outlier.largest_share(), 1.0 / 12, 1e-12);
}

TEST(FilmError, OutliersAreFound) {
    Film film = film_of(10);
    for (int x = 0; x < 10; ++x)
        for (int i = 0; i < 10; ++i) add(film.pixel(x, 0), {1.5f, 0.5f});
    OutlierReport even = outliers_of(film);
    EXPECT_EQ(even.pixels_of_half, 5u);
    EXPECT_NEAR(even.share_of_half, 0.5, 1e-12);
    EXPECT_EQ(even.heavy_tailed, 0u);
    EXPECT_EQ(even.outshone, 0u);
    add(film.pixel(3, 0), {1000});
    const OutlierReport one = outliers_of(film);
    EXPECT_EQ(one.pixels_of_half, 1u);
    EXPECT_EQ(one.heavy_tailed, 1u);
    EXPECT_GT(one.heavy_error_share, 0.99);
    EXPECT_EQ(one.outshone, 2u);
}

} // namespace
} // namespace montelux
