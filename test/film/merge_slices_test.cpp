#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/film/film.h"
#include "montelux/film/merge_slices.h"
#include "montelux/film/pixel_warnings.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/random/philox_stream.h"

namespace montelux {
namespace {

constexpr int slice_width = 4, slice_height = 3;

Film empty() {
    return Film({.width = slice_width, .height = slice_height, .crop = {0, 0, slice_width, slice_height}});
}

// The replicates k, k + n, ... of a picture of skewed samples; all of them for {0, 1}.
Film slice_film(int k, int n, int replicates) {
    Film film = empty();
    for (int y = 0; y < slice_height; ++y)
        for (int x = 0; x < slice_width; ++x)
            for (int u = k; u < replicates; u += n) {
                PhiloxStream random(static_cast<std::uint64_t>(u * 100 + y * slice_width + x));
                const auto v = static_cast<float>(-std::log(1 - random.next_double()));
                film.pixel(x, y).add_sample({.radiance = {v, v * v, 1 + v},
                                             .albedo = {v, 0.5f, 0.25f},
                                             .normal = {0, v, 1},
                                             .depth = 1 + v});
                film.pixel(x, y).end_replicate();
            }
    return film;
}
Image picture(int k, int n, int replicates) {
    Image image = slice_film(k, n, replicates).develop(n > 1);
    image.attributes()["renderHash"] = std::string("abc");
    image.attributes()["slice"] = std::to_string(k + 1) + "/" + std::to_string(n);
    image.attributes()["badSamples"] = 2;
    return image;
}

MergedSlices merge(const std::vector<Image>& slices, const std::vector<std::string>& names) {
    SliceMerger merger;
    for (std::size_t i = 0; i < slices.size(); ++i) merger.add(slices[i], names[i]);
    return merger.finish();
}

MergedSlices merge_all(int slices, int replicates) {
    std::vector<Image> pictures;
    std::vector<std::string> names;
    for (int k = slices - 1; k >= 0; --k) {
        pictures.push_back(picture(k, slices, replicates));
        names.push_back("slice " + std::to_string(k + 1));
    }
    return merge(pictures, names);
}

// With many replicates and few, of different lengths; one replicate has no spread.
TEST(MergeSlices, AllLayersAreThoseOfTheWhole) {
    const int replicates = 40;
    const Film film = slice_film(0, 1, replicates);
    const Image whole = film.develop();
    int stand_out = 0;
    for (int y = 0; y < slice_height; ++y)
        for (int x = 0; x < slice_width; ++x)
            stand_out +=
                whole.value(x, y, *whole.find_channel("warning")) == float(PixelWarning::bright_replicate);
    EXPECT_GT(stand_out, 1);
    EXPECT_LT(stand_out, slice_width * slice_height - 1);
    for (int slices : {1, 3, 13, 20, 39, 40}) {
        const MergedSlices merged = merge_all(slices, replicates);
        EXPECT_TRUE(merged.missing.empty());
        ASSERT_EQ(merged.image.channel_names(), whole.channel_names());
        for (int c = 0; c < whole.channels(); ++c)
            for (int y = 0; y < slice_height; ++y)
                for (int x = 0; x < slice_width; ++x) {
                    const double expected = whole.value(x, y, c);
                    EXPECT_NEAR(merged.image.value(x, y, c), expected, 2e-6 * (0.1 + std::abs(expected)))
                        << whole.channel_names()[static_cast<std::size_t>(c)] << " of " << slices;
                }
        EXPECT_NEAR(merged.relative_error, film.error().relative, 1e-6);
        EXPECT_EQ(merged.mean_samples, replicates);
        EXPECT_EQ(std::get<int>(merged.image.attributes().at("badSamples")), 2 * slices);
        EXPECT_EQ(std::get<std::string>(merged.image.attributes().at("slice")), "1/1");
    }
}

// One slice meets the light, and all the others are dark.
TEST(MergeSlices, TheBrightestReplicateIsHeldAgainstTheMeanOfAll) {
    std::vector<Image> slices;
    std::vector<std::string> names;
    for (int k = 0; k < 16; ++k) {
        Film film = empty();
        for (Pixel& p : film.pixels()) {
            const float v = k == 5 ? 9 : 0.01f * static_cast<float>(k);
            p.add_sample({.radiance = {v, v, v}, .albedo = {}, .normal = {}});
            p.end_replicate();
        }
        slices.push_back(film.develop(true));
        slices.back().attributes()["renderHash"] = std::string("abc");
        slices.back().attributes()["slice"] = std::to_string(k + 1) + "/16";
        names.push_back(std::to_string(k));
    }
    const Image joined = merge(slices, names).image;
    EXPECT_GT(joined.value(1, 1, *joined.find_channel("outlier")), 0.9);
    EXPECT_EQ(joined.value(1, 1, *joined.find_channel("warning")), float(PixelWarning::bright_replicate));
}

// Too dark for all samples together, and the errors do not know of it.
TEST(MergeSlices, ClampedLightIsJoined) {
    std::vector<Image> slices{picture(0, 3, 40), picture(1, 3, 40), picture(2, 3, 40)};
    const std::vector<std::string> names{"a", "b", "c"};
    EXPECT_FALSE(merge(slices, names).image.attributes().contains("clampedLuminance"));
    // As a slice that is interrupted has fewer samples.
    for (int k = 0; k < 3; ++k) {
        Attributes& a = slices[static_cast<std::size_t>(k)].attributes();
        a["samplesTaken"] = k == 0 ? 4.0f : 8.0f;
        if (k == 2) continue;
        a["clampedLuminance"] = k == 0 ? 0.25f : 0.5f;
        a["clampedSamples"] = k == 0 ? 70 : 30;
    }
    const MergedSlices merged = merge(slices, names);
    EXPECT_NEAR(merged.clamped_luminance, (4 * 0.25 + 8 * 0.5) / 20, 1e-6);
    EXPECT_EQ(merged.clamped_samples, 100);
    EXPECT_NEAR(std::get<float>(merged.image.attributes().at("clampedLuminance")), 0.25f, 1e-6f);
    EXPECT_EQ(std::get<int>(merged.image.attributes().at("clampedSamples")), 100);
}

TEST(MergeSlices, OneInterruptedSliceIsEnough) {
    const std::vector<std::string> names{"a", "b", "c"};
    for (int interrupted = -1; interrupted < 3; ++interrupted) {
        std::vector<Image> slices{picture(0, 3, 40), picture(1, 3, 40), picture(2, 3, 40)};
        for (int k = 0; k < 3; ++k)
            slices[static_cast<std::size_t>(k)].attributes()["interrupted"] = int{k == interrupted};
        const auto found = merge(slices, names).image.attributes().at("interrupted");
        EXPECT_EQ(std::get<int>(found), int{interrupted >= 0}) << interrupted;
    }
}

// Pictures that are not slices lack the brightest replicates; nothing is lost where there is one alone.
TEST(MergeSlices, OneWholePictureStaysWhatItIs) {
    const Image whole = picture(0, 1, 24);
    EXPECT_FALSE(whole.find_channel("brightest.R"));
    const std::vector<Image> pictures{whole};
    const std::vector<std::string> names{"whole"};
    const Image joined = merge(pictures, names).image;
    for (const char* layer : {"outlier", "warning"}) {
        const int c = *whole.find_channel(layer);
        for (int y = 0; y < slice_height; ++y)
            for (int x = 0; x < slice_width; ++x)
                EXPECT_NEAR(joined.value(x, y, c), whole.value(x, y, c), 2e-6) << layer;
    }
}

TEST(MergeSlices, MissingOnesAreReported) {
    const std::vector<Image> slices{picture(3, 4, 40)};
    const std::vector<std::string> names{"d"};
    EXPECT_EQ(merge(slices, names).missing, (std::vector<int>{1, 2, 3}));
}

TEST(MergeSlices, WhatDoesNotFitIsRefused) {
    auto refused = [](const std::vector<Image>& slices, const std::string& why) {
        const std::vector<std::string> names{"a", "b"};
        try {
            merge(slices, names);
            ADD_FAILURE() << why;
        } catch (const Error& e) {
            EXPECT_NE(std::string(e.what()).find(why), std::string::npos) << e.what();
        }
    };
    const Image a = picture(0, 2, 8), b = picture(1, 2, 8);
    Image other = b;
    other.attributes()["renderHash"] = std::string("def");
    refused({a, other}, "b: it is of another render than a");
    refused({a, a}, "b: it is slice 1, as a is");
    refused({a, picture(1, 3, 8)}, "b: it is one of 3 slices, but a is one of 2");
    Image nameless = b;
    nameless.attributes().erase("slice");
    refused({a, nameless}, "no attribute slice");
    Image odd = b;
    odd.attributes()["slice"] = std::string("some of 3");
    refused({a, odd}, "K/N is expected");
    const std::vector<std::string> colours{"R", "G", "B"};
    refused({a, b.select(colours)}, "no layer stderr.R");
    Image small(2, 2, a.channel_names());
    small.attributes() = b.attributes();
    refused({a, small}, "another size");
    EXPECT_THROW(SliceMerger().finish(), Error);
}

} // namespace
} // namespace montelux
