#include <gtest/gtest.h>
#include <limits>
#include <string>
#include <vector>

#include "montelux/image/visible_error.h"

namespace montelux {
namespace {

// A row of grey pixels of one light, with these standard errors.
Image picture(float light, const std::vector<float>& errors) {
    Image image(static_cast<int>(errors.size()), 1, {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B"});
    std::size_t i = 0;
    for (const float e : errors)
        for (int c = 0; c < 6; ++c) image.f32()[i++] = c < 3 ? light : e;
    return image;
}

TEST(VisibleError, OneCodeOfLinearLight) {
    constexpr float code = 1.0f / 255;
    const ToneCurve linear{.exposure = 0, .kind = ToneKind::linear};
    const Image p = picture(0.5f, {0.9f * code, 1.1f * code, 0, 2 * code});
    EXPECT_DOUBLE_EQ(visible_error_share(p, linear).value(), 0.5);
    // Twice the light has twice the error: 1.8, 2.2 and 4 codes; but it is cut off at white, and half of it is left.
    EXPECT_DOUBLE_EQ(visible_error_share(p, {.exposure = 1, .kind = ToneKind::linear}).value(), 0.5);
    EXPECT_DOUBLE_EQ(visible_error_share(p, {.exposure = -2, .kind = ToneKind::linear}).value(), 0);
}

TEST(VisibleError, CurvesShowMoreInTheDark) {
    const ToneCurve srgb;
    const std::vector<float> errors{0.001f};
    EXPECT_EQ(visible_error_share(picture(0.9f, errors), srgb).value(), 0);
    EXPECT_EQ(visible_error_share(picture(0.01f, errors), srgb).value(), 1);
    // Beyond white nothing shows.
    EXPECT_EQ(visible_error_share(picture(50, {10}), srgb).value(), 0);
}

TEST(VisibleError, OfUnknownErrors) {
    EXPECT_EQ(visible_error_share(picture(0.5f, {std::numeric_limits<float>::infinity(), 0}), {}).value(),
              0.5);
    EXPECT_FALSE(visible_error_share(Image(2, 2, {"R", "G", "B"}), {}));
    EXPECT_FALSE(visible_error_share(Image(2, 2, {"depth.Z"}), {}));
}

TEST(VisibleError, IsThatOfLuminance) {
    Image image(1, 1, {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B"});
    const ToneCurve linear{.exposure = 0, .kind = ToneKind::linear};
    for (int c = 0; c < 3; ++c) image.f32()[static_cast<std::size_t>(c)] = 0.5f;
    image.f32()[5] = 10.0f / 255; // blue: 0.72 codes of luminance
    EXPECT_EQ(visible_error_share(image, linear).value(), 0);
    image.f32()[5] = 15.0f / 255;
    EXPECT_EQ(visible_error_share(image, linear).value(), 1);
}

} // namespace
} // namespace montelux
