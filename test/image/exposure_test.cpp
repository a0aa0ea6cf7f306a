#include "test/image/image_testing.h"
#include <cmath>
#include <limits>

#include "montelux/image/exposure.h"

namespace montelux {
namespace {

// Of 1000 pixels, the first `count` have the light `first`, the others `rest`.
Image two_tones(int count, float first, float rest) {
    Image image(1000, 1, {"R", "G", "B"});
    for (int x = 0; x < 1000; ++x)
        for (int c = 0; c < 3; ++c) image.set(x, 0, c, x < count ? first : rest);
    return image;
}

TEST(Exposure, AutomaticExposureBringsTheLogAverageToTheKey) {
    Image image(2, 2, {"R", "G", "B"});
    const float light[] = {0.01f, 1, 100, 0}; // log-average of the lit ones: 1
    for (int i = 0; i < 4; ++i)
        for (int c = 0; c < 3; ++c) image.set(i % 2, i / 2, c, light[i]);
    EXPECT_NEAR(automatic_exposure(image), std::log2(0.18), 1e-5);
    EXPECT_EQ(automatic_exposure(Image(1, 1, {"Y"})), 0);
}

TEST(Exposure, IsBounded) {
    EXPECT_EQ(automatic_exposure(two_tones(0, 0, 1e-42f)), most_exposure);
    EXPECT_EQ(automatic_exposure(two_tones(0, 0, 3e38f)), least_exposure);
}

TEST(Exposure, IsChosenOnlyWhereNothingWouldBeSeen) {
    EXPECT_EQ(suitable_exposure(two_tones(989, 50, 0.5f), ToneKind::srgb), 0); // 98.9 % white
    EXPECT_LT(suitable_exposure(two_tones(991, 50, 0.5f), ToneKind::srgb), -7);
    EXPECT_EQ(suitable_exposure(two_tones(989, 1e-5f, 0.5f), ToneKind::srgb), 0);
    EXPECT_GT(suitable_exposure(two_tones(991, 1e-5f, 0.5f), ToneKind::srgb), 13);
    // A small bright thing in the dark is as it should be: there is no other light to show.
    EXPECT_EQ(suitable_exposure(two_tones(995, 0, 0.5f), ToneKind::srgb), 0);
    EXPECT_EQ(suitable_exposure(two_tones(0, 0, 0), ToneKind::srgb), 0);
    // Curves end at different lights.
    EXPECT_EQ(suitable_exposure(two_tones(0, 0, 1.5f), ToneKind::aces), 0);
    EXPECT_LT(suitable_exposure(two_tones(0, 0, 1.5f), ToneKind::srgb), 0);
    // Codes are finished.
    EXPECT_EQ(suitable_exposure(Image(8, 8, {"R", "G", "B"}, PixelFormat::u8), ToneKind::srgb), 0);
    EXPECT_EQ(suitable_exposure(Image(8, 8, {"depth"}), ToneKind::srgb), 0);
}

TEST(Exposure, SharesCountTheTones) {
    Image image = two_tones(250, 0, 1e-5f);
    for (int x = 500; x < 600; ++x)
        for (int c = 0; c < 3; ++c) image.set(x, 0, c, std::numeric_limits<float>::infinity());
    image.set(999, 0, 0, std::numeric_limits<float>::quiet_NaN());
    const ToneShares shares = tone_shares(image, {});
    EXPECT_DOUBLE_EQ(shares.white, 0.1);
    EXPECT_DOUBLE_EQ(shares.black, 0.9);
    EXPECT_TRUE(shares.any_light);
    EXPECT_DOUBLE_EQ(shares.dim, 649 / 749.0); // a pixel that is not a number has no light
    EXPECT_FALSE(tone_shares(two_tones(0, 0, 0), {}).any_light);
    EXPECT_EQ(tone_shares(Image(2, 2, {"depth"}), {}).black, 0);
}

} // namespace
} // namespace montelux
