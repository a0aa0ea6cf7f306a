#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/film/film.h"
#include "montelux/film/merge_slices.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/random/philox_stream.h"

namespace montelux {
namespace {

constexpr int width = 4, height = 3;

Film empty() { return Film({.width = width, .height = height, .crop = {0, 0, width, height}}); }

// The units k, k + n, ... of a picture of skewed samples; all of them for {0, 1}.
Film slice_film(int k, int n, int units) {
    Film film = empty();
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int u = k; u < units; u += n) {
                PhiloxStream random(static_cast<std::uint64_t>(u * 100 + y * width + x));
                const auto v = static_cast<float>(-std::log(1 - random.next_double()));
                film.pixel(x, y).add_sample({.radiance = {v, v * v, 1 + v},
                                             .albedo = {v, 0.5f, 0.25f},
                                             .normal = {0, v, 1},
                                             .depth = 1 + v});
                film.pixel(x, y).end_unit();
            }
    return film;
}
Image picture(int k, int n, int units) {
    Image image = slice_film(k, n, units).develop();
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

TEST(MergeSlices, AllLayersAreThoseOfTheWhole) {
    const Film film = slice_film(0, 1, 40);
    const Image whole = film.develop();
    // Of different lengths, in another order.
    const std::vector<Image> slices{picture(2, 3, 40), picture(0, 3, 40), picture(1, 3, 40)};
    const std::vector<std::string> names{"c", "a", "b"};
    const MergedSlices merged = merge(slices, names);
    EXPECT_TRUE(merged.missing.empty());
    ASSERT_EQ(merged.image.channel_names(), whole.channel_names());
    for (int c = 0; c < whole.channels(); ++c) {
        const std::string& name = whole.channel_names()[static_cast<std::size_t>(c)];
        // The slices' own means stand for that of all in `outlier`.
        const double tolerance = name == "outlier" ? 0.5 : 2e-6;
        auto stands_out = [&](const Image& image, int x, int y) {
            return image.value(x, y, *image.find_channel("outlier")) > 0.5f;
        };
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                if (name == "doubt" && stands_out(whole, x, y) != stands_out(merged.image, x, y)) continue;
                const double expected = whole.value(x, y, c);
                EXPECT_NEAR(merged.image.value(x, y, c), expected, tolerance * (0.1 + std::abs(expected)))
                    << name;
            }
    }
    EXPECT_NEAR(merged.relative_error, film.error().relative, 1e-6);
    EXPECT_EQ(merged.mean_samples, 40);
    EXPECT_EQ(std::get<int>(merged.image.attributes().at("badSamples")), 6);
    EXPECT_EQ(std::get<std::string>(merged.image.attributes().at("slice")), "1/1");
}

TEST(MergeSlices, MissingOnesAreTold) {
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
