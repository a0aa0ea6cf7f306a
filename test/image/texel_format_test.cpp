#include "test/image/image_testing.h"
#include "test/image/ktx2_reading.h"
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>

#include "montelux/image/half.h"
#include "montelux/image/image_read.h"
#include "montelux/image/image_write.h"
#include "montelux/image/texel_format.h"

namespace montelux {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
const float nan_value = std::numeric_limits<float>::quiet_NaN();

Image one_texel(float r, float g, float b) {
    Image image(1, 1, {"R", "G", "B"});
    image.set(0, 0, 0, r);
    image.set(0, 0, 1, g);
    image.set(0, 0, 2, b);
    return image;
}

struct Encoded {
    std::vector<std::uint8_t> bytes;
    TexelLosses losses;
    std::uint32_t word() const {
        return bytes[0] | bytes[1] << 8 | bytes[2] << 16 | static_cast<std::uint32_t>(bytes[3]) << 24;
    }
};
Encoded encode(const Image& image, TexelFormat format, const RgbmScale& scale = {}) {
    Encoded e;
    append_texels(e.bytes, "test", image, format, scale, e.losses);
    EXPECT_EQ(e.bytes.size(), image.pixel_count() * bytes_per_texel(format));
    return e;
}

// Each code is the nearest to what it means and to what lies within half a step of it; ties go to even.
void expect_nearest(int mantissa, const std::function<std::uint32_t(float)>& code_of) {
    const std::uint32_t codes = 31u << mantissa;
    for (std::uint32_t code = 0; code<codes; code += mantissa> 6 ? 7 : 1) {
        const double v = decode_small_float(code, mantissa);
        ASSERT_EQ(code_of(static_cast<float>(v)), code);
        if (code + 1 == codes) break;
        const double next = decode_small_float(code + 1, mantissa), middle = (v + next) / 2;
        ASSERT_EQ(code_of(std::nextafter(static_cast<float>(middle), 0.0f)), code);
        ASSERT_EQ(code_of(std::nextafter(static_cast<float>(middle), infinity)), code + 1);
        ASSERT_EQ(code_of(static_cast<float>(middle)), code + code % 2);
    }
}

TEST(TexelFormat, HalvesAndSmallFloatsRoundToNearestEven) {
    auto half = [](float v) { return encode(one_texel(v, 0, 0), TexelFormat::rgba16f).word() & 0xffffu; };
    auto red = [](float v) { return encode(one_texel(v, 0, 0), TexelFormat::r11g11b10f).word(); };
    auto green = [](float v) { return encode(one_texel(0, v, 0), TexelFormat::r11g11b10f).word() >> 11; };
    auto blue = [](float v) { return encode(one_texel(0, 0, v), TexelFormat::r11g11b10f).word() >> 22; };
    expect_nearest(10, half);
    expect_nearest(6, red);
    expect_nearest(6, green);
    expect_nearest(5, blue);
}

TEST(TexelFormat, SharedExponentsAreTheFinestThatFit) {
    for (std::uint64_t i = 0; i < 5000; ++i) {
        std::array<float, 3> v;
        for (std::size_t c = 0; c < 3; ++c)
            v[c] = static_cast<float>(std::exp2(40 * noise(6 * i + 2 * c) - 25) * noise(6 * i + 2 * c + 1));
        if (i % 10 == 0) v[1] = 65408;
        if (i % 10 == 1) v[2] = static_cast<float>(std::ldexp(511.6, static_cast<int>(i % 28) - 24));
        const float most = std::max({v[0], v[1], v[2]});
        const Encoded e = encode(one_texel(v[0], v[1], v[2]), TexelFormat::rgb9e5);
        if (most > 65408) continue;
        EXPECT_FALSE(e.losses.any());
        const int exponent = static_cast<int>(e.word() >> 27);
        const double step = std::ldexp(1, exponent - 24);
        for (int c = 0; c < 3; ++c)
            ASSERT_LE(std::abs((e.word() >> (9 * c) & 0x1ffu) * step - double{v[c]}), step / 2) << most;
        // With half the step the largest would not fit.
        if (exponent > 0) {
            ASSERT_GT(std::floor(double{most} / (step / 2) + 0.5), 511) << most;
        }
    }
}

TEST(TexelFormat, RgbmIsWhatItsDefinitionSays) {
    for (const RgbmScale& scale : {RgbmScale{6, 1}, RgbmScale{16, 1}, RgbmScale{8, 2}, RgbmScale{16, 2}})
        for (std::uint64_t i = 0; i < 5000; ++i) {
            const double limit = std::pow(scale.range, scale.power);
            std::array<float, 3> v;
            for (std::size_t c = 0; c < 3; ++c)
                v[c] = static_cast<float>(limit * std::exp2(-20 * noise(4 * i + 3)) * noise(4 * i + c));
            const Encoded e = encode(one_texel(v[0], v[1], v[2]), TexelFormat::rgbm8, scale);
            EXPECT_FALSE(e.losses.any());
            const double m = e.bytes[3] / 255.0, step = scale.range * m / 255;
            ASSERT_GE(e.bytes[3], 1);
            for (std::size_t c = 0; c < 3; ++c) {
                const double root = scale.power == 2 ? std::sqrt(double{v[c]}) : double{v[c]};
                ASSERT_LE(std::abs(e.bytes[c] * step - root), step * 0.5001);
            }
            // A smaller M would cut the largest.
            const double most = std::pow(double{std::max({v[0], v[1], v[2]})}, 1.0 / scale.power);
            if (e.bytes[3] > 1) {
                ASSERT_GT(most, scale.range * (e.bytes[3] - 1) / 255.0);
            }
        }
    // Its own values come back as they are.
    const Encoded e = encode(one_texel(16, 8 * 0.4f, 0), TexelFormat::rgbm8, {16, 1});
    EXPECT_EQ(e.bytes, (std::vector<std::uint8_t>{255, 51, 0, 255}));
}

TEST(TexelFormat, WhatDoesNotFitBecomesTheNearestThatDoesAndIsCounted) {
    struct Case {
        TexelFormat format;
        double largest;
        bool has_sign;
    };
    for (const Case& k :
         {Case{TexelFormat::rgba16f, 65504, true}, Case{TexelFormat::rgba32f, 0x1.fffffep127, true},
          Case{TexelFormat::r11g11b10f, 65024, false}, Case{TexelFormat::rgb9e5, 65408, false},
          Case{TexelFormat::rgbm8, 16, false}}) {
        SCOPED_TRACE(name_of(k.format));
        const auto fits = encode(one_texel(static_cast<float>(k.largest), 0, 0), k.format);
        EXPECT_FALSE(fits.losses.any());
        const auto large = encode(one_texel(infinity, 0, 0), k.format);
        EXPECT_EQ(large.bytes, fits.bytes);
        EXPECT_EQ(large.losses.too_large, 1u);
        EXPECT_EQ(large.losses.largest, infinity);
        const auto nothing = encode(one_texel(0, 0, 0), k.format);
        const auto bad = encode(one_texel(nan_value, nan_value, 0), k.format);
        EXPECT_EQ(bad.bytes, nothing.bytes);
        EXPECT_EQ(bad.losses.not_number, 2u);
        EXPECT_EQ(bad.losses.too_large + bad.losses.negative, 0u);
        const auto below = encode(one_texel(-3, -0.0f, -infinity), k.format);
        if (k.has_sign) {
            EXPECT_EQ(below.losses.negative, 0u);
            EXPECT_EQ(below.losses.too_large, 1u);
        } else {
            EXPECT_EQ(below.bytes, nothing.bytes);
            EXPECT_EQ(below.losses.negative, 2u);
        }
    }
    // 65519.996 rounds to 65504; 65520 would round to infinity.
    EXPECT_FALSE(encode(one_texel(65519.996f, 0, 0), TexelFormat::rgba16f).losses.any());
    EXPECT_EQ(encode(one_texel(65520, 0, 0), TexelFormat::rgba16f).losses.too_large, 1u);
    EXPECT_EQ(encode(one_texel(0, 0, 65024), TexelFormat::r11g11b10f).losses.too_large, 1u);
    EXPECT_EQ(encode(one_texel(0, 0, 65023), TexelFormat::r11g11b10f).losses.too_large, 0u);
}

TEST(TexelFormat, LossesMakeASentence) {
    TexelLosses losses{.too_large = 2, .negative = 1, .not_number = 0, .largest = 1e6f};
    losses += TexelLosses{.too_large = 1, .negative = 0, .not_number = 3, .largest = 7e4f};
    EXPECT_EQ(
        losses.sentence(TexelFormat::rgb9e5),
        "3 values were larger than rgb9e5 can hold (up to 1e+06) and became its largest number; 1 value "
        "was negative and became 0, for rgb9e5 has no sign; 3 values were not a number and became 0");
    EXPECT_EQ(TexelLosses{}.sentence(TexelFormat::rgb9e5), "");
}

TEST(TexelFormat, NamesLeadBack) {
    for (const char* name : {"rgba16f", "rgba32f", "rg16f", "rg32f", "rgb9e5", "r11g11b10f", "rgbm8"}) {
        ASSERT_TRUE(texel_format_named(name)) << name;
        EXPECT_EQ(name_of(*texel_format_named(name)), name);
    }
    EXPECT_FALSE(texel_format_named("rgba8"));
}

TEST(TexelFormat, RgbmPicturesKeepTheirBytesInAPng) {
    TemporaryFolder folder;
    Image light(16, 16, {"R", "G", "B"});
    for (std::size_t i = 0; i < light.sample_count(); ++i)
        light.f32()[i] = static_cast<float>(std::exp2(12 * noise(i) - 9));
    TexelLosses losses;
    const Image picture = rgbm_picture(light, {16, 1}, losses);
    EXPECT_FALSE(losses.any());
    write_image(folder / "a.png", picture);
    const Image back = read_image(folder / "a.png");
    ASSERT_EQ(back.channel_names(), (std::vector<std::string>{"R", "G", "B", "A"}));
    ASSERT_EQ(back.format(), PixelFormat::u8);
    EXPECT_EQ(std::vector<std::uint8_t>(back.u8().begin(), back.u8().end()),
              std::vector<std::uint8_t>(picture.u8().begin(), picture.u8().end()));
    const std::vector<std::uint8_t> bytes = encode(light, TexelFormat::rgbm8).bytes;
    EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), picture.u8().begin()));
}

} // namespace
} // namespace montelux
