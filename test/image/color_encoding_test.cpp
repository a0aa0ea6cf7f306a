#include "test/image/image_testing.h"
#include <limits>

#include "montelux/image/color_encoding.h"
#include "montelux/image/half.h"

namespace montelux {
namespace {

TEST(SrgbCurve, HasTheStandardsValues) {
    // IEC 61966-2-1: ((v + 0.055) / 1.055)^2.4 above 0.04045, v / 12.92 below.
    EXPECT_DOUBLE_EQ(srgb_to_linear(0.5), 0.21404114048223255);
    EXPECT_DOUBLE_EQ(srgb_to_linear(0.04), 0.04 / 12.92);
    EXPECT_DOUBLE_EQ(srgb_to_linear(1.0), 1.0);
    EXPECT_DOUBLE_EQ(srgb_to_linear(-0.5), -0.21404114048223255);
    EXPECT_NEAR(linear_to_srgb(0.18), 0.4613561295004425, 1e-12);
}

TEST(SrgbCurve, GoesThereAndBack) {
    for (int i = -1000; i <= 3000; ++i) {
        double v = i / 1000.0;
        EXPECT_NEAR(linear_to_srgb(srgb_to_linear(v)), v, 1e-14 + 1e-14 * std::abs(v));
    }
}

TEST(SrgbCurve, BytesComeBackAndAreNearest) {
    for (int i = 0; i < 256; ++i) {
        EXPECT_EQ(srgb8_to_linear_table()[i], srgb_to_linear(static_cast<float>(i) / 255));
        EXPECT_EQ(linear_to_srgb8(srgb8_to_linear_table()[i]), i);
    }
    for (std::uint64_t i = 0; i < 20000; ++i) {
        float x = static_cast<float>(noise(i) * 1.2 - 0.1);
        double exact = std::floor(255 * linear_to_srgb(static_cast<double>(x)) + 0.5);
        EXPECT_EQ(linear_to_srgb8(x), std::clamp(exact, 0.0, 255.0)) << x;
    }
    EXPECT_EQ(linear_to_srgb8(std::numeric_limits<float>::quiet_NaN()), 0);
    EXPECT_EQ(linear_to_srgb8(std::numeric_limits<float>::infinity()), 255);
}

TEST(ColorEncoding, GammaIsAPower) {
    auto gamma = ColorEncoding::gamma(2.2f);
    EXPECT_NEAR(gamma.to_linear(0.5f), std::pow(0.5, 2.2), 1e-6);
    EXPECT_NEAR(gamma.from_linear(gamma.to_linear(0.3f)), 0.3, 1e-6);
    EXPECT_EQ(ColorEncoding::linear().to_linear(0.3f), 0.3f);
    expect_error([] { ColorEncoding::gamma(0); }, {"gamma", "positive"});
    expect_error([] { ColorEncoding::gamma(std::numeric_limits<float>::quiet_NaN()); }, {"gamma"});
}

TEST(Half, AllValuesComeBack) {
    for (int i = 0; i < 65536; ++i) {
        auto h = static_cast<std::uint16_t>(i);
        float f = half_to_float(h);
        if (std::isnan(f))
            EXPECT_TRUE((i & 0x7c00) == 0x7c00 && (i & 0x3ff) != 0);
        else
            EXPECT_EQ(float_to_half(f), h);
    }
    EXPECT_EQ(half_to_float(0x3c00), 1);
    EXPECT_EQ(half_to_float(0x0001), 0x1p-24f);
    EXPECT_EQ(half_to_float(0xfbff), -65504);
    EXPECT_EQ(float_to_half(65520), 0x7c00);
    EXPECT_EQ(float_to_half(1 + 0x1p-11f), 0x3c00); // a tie goes to the even one
    EXPECT_EQ(float_to_half(1 + 0x3p-11f), 0x3c02);
}

} // namespace
} // namespace montelux
