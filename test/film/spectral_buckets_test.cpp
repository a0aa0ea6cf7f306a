// Buckets of wavelengths: which wavelength belongs where, unbiased means, names of layers.
#include <gtest/gtest.h>

#include "montelux/film/film.h"
#include "montelux/film/spectral_buckets.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/random/philox_stream.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/mc/stats/z_test.h"

namespace montelux {
namespace {

TEST(SpectralBuckets, EveryWavelengthHasOne) {
    const BucketLayout layout({.lambda_min = 400, .lambda_max = 700, .buckets = 30});
    EXPECT_FLOAT_EQ(layout.width(), 10);
    EXPECT_FLOAT_EQ(layout.center(0), 405);
    EXPECT_FLOAT_EQ(layout.center(29), 695);
    EXPECT_EQ(layout.of(400), 0);
    EXPECT_EQ(layout.of(409.9f), 0);
    EXPECT_EQ(layout.of(410), 1);
    EXPECT_EQ(layout.of(700), 29);
    EXPECT_EQ(layout.of(399.9f), -1);
    EXPECT_EQ(layout.of(700.1f), -1);
}

TEST(SpectralBuckets, SamplesReachTheLastOfTheMost) {
    const BucketLayout layout(
        {.lambda_min = 400, .lambda_max = 700, .buckets = SpectralSettings::most_buckets});
    for (const float u : {0.1f, 0.5f, 0.9f}) {
        const auto w = SampledWavelengths::sample_visible(u);
        const SpectralSample s = spectral_sample(layout, SampledSpectrum(1), w, 1);
        for (int i = 0; i < 4; ++i)
            EXPECT_EQ(int{s.bucket[static_cast<std::size_t>(i)]}, layout.of(w.lambda[i])) << w.lambda[i];
    }
    SampledWavelengths last = SampledWavelengths::sample_visible(0.5f);
    last.lambda[0] = 700;
    EXPECT_EQ(int{spectral_sample(layout, SampledSpectrum(1), last, 1).bucket[0]}, 511);
}

TEST(SpectralBuckets, LayersAreNamedAsInTheLayout) {
    EXPECT_EQ(spectral_layer(550), "S0.550,000nm");
    EXPECT_EQ(spectral_layer(374.6875f), "S0.374,688nm");
}

// A straight line of radiance over wavelength has its value at the centre as the mean of a bucket.
TEST(SpectralBuckets, SamplesAreUnbiased) {
    const SpectralSettings settings{.lambda_min = 380, .lambda_max = 760, .buckets = 5};
    const BucketLayout layout(settings);
    const auto radiance = [](float lambda) { return 0.01f + (lambda - 360) * 1e-4f; };
    for (const bool terminate : {false, true}) {
        PhiloxStream stream(11);
        std::vector<RunningMoments> moments(5);
        for (int k = 0; k < 200000; ++k) {
            auto w = SampledWavelengths::sample_visible(stream.next_1d());
            const SampledSpectrum l(radiance(w.lambda[0]), radiance(w.lambda[1]), radiance(w.lambda[2]),
                                    radiance(w.lambda[3]));
            if (terminate) w.terminate_secondary();
            std::vector<BucketMoments> buckets(5);
            add_sample(buckets, spectral_sample(layout, l, w, 2));
            for (std::size_t i = 0; i < 5; ++i) moments[i].add(buckets[i].open);
        }
        for (int i = 0; i < 5; ++i) {
            const double truth = 2 * double(radiance(layout.center(i))) * cie_y_integral;
            const auto r = unbiasedness_test(moments[static_cast<std::size_t>(i)], truth);
            EXPECT_TRUE(r.passes(1e-8)) << r.description;
        }
    }
}

TEST(SpectralBuckets, MomentsAreThoseOfTheReplicates) {
    FilmSettings settings;
    settings.width = settings.height = 1;
    settings.crop = {0, 0, 1, 1};
    settings.spectral = SpectralSettings{.buckets = 2};
    Film film(settings);
    EXPECT_EQ(film.buckets_per_pixel(), 2u);
    Pixel& pixel = film.pixel(0, 0);
    const double values[] = {1, 3, 8, 4, 2, 6}; // two samples for each replicate
    for (int r = 0; r < 3; ++r) {
        for (int k = 0; k < 2; ++k) {
            pixel.add_sample({});
            film.buckets()[1].open += values[2 * r + k];
        }
        if (r == 2) break; // left open
        for (BucketMoments& b : film.buckets())
            b.end_replicate(pixel.open_samples(), pixel.replicates().count() + 1);
        pixel.end_replicate();
    }
    film.end_replicates(2);
    // Replicates 2, 6, 4.
    EXPECT_DOUBLE_EQ(film.buckets()[1].mean, 4);
    EXPECT_DOUBLE_EQ(film.buckets()[1].standard_error(3), std::sqrt(4.0 / 3));
    EXPECT_EQ(film.buckets()[0].mean, 0);
    const Image image = film.develop();
    EXPECT_EQ(image.value(0, 0, *image.find_channel("S0.712,500nm")), 4);
    EXPECT_FLOAT_EQ(image.value(0, 0, *image.find_channel("stderr.S0.712,500nm")), std::sqrt(4.0f / 3));
    // A small rest is dropped, as that of the pixel.
    pixel.add_sample({});
    film.buckets()[1].open = 100;
    film.end_replicates(4);
    EXPECT_DOUBLE_EQ(film.buckets()[1].mean, 4);
    EXPECT_EQ(pixel.replicates().count(), 3u);
    EXPECT_THROW(
        Film({.width = 1, .height = 1, .crop = {0, 0, 1, 1}, .spectral = SpectralSettings{.buckets = 0}}),
        Error);
}

TEST(SpectralBuckets, RowsAreCopiedWithTheirBuckets) {
    const FilmSettings settings{
        .width = 4, .height = 3, .crop = {1, 1, 4, 3}, .spectral = SpectralSettings{.buckets = 2}};
    Film from(settings), to(settings);
    for (std::size_t i = 0; i < from.buckets().size(); ++i)
        from.buckets()[i].mean = static_cast<double>(i + 1);
    to.copy_row(from, 2, 2, 2); // the last two of six pixels
    for (std::size_t i = 0; i < 12; ++i)
        EXPECT_EQ(to.buckets()[i].mean, i < 8 ? 0 : static_cast<double>(i + 1)) << i;
}

} // namespace
} // namespace montelux
