// Warnings about finished pictures.
#include <gtest/gtest.h>
#include <limits>
#include <string>
#include <vector>

#include "montelux/render/render_warnings.h"

namespace montelux {
namespace {

// Pixels in a row: of surfaces that are lit, of black ones, and of none.
Image picture(int lit, int black, int empty) {
    Image image(lit + black + empty, 1, {"R", "G", "B", "depth.Z"});
    for (int x = 0; x < image.width(); ++x) {
        image.set(x, 0, 2, x < lit ? 0.5f : 0);
        image.set(x, 0, 3, x < lit + black ? 3 : std::numeric_limits<float>::infinity());
    }
    return image;
}

TEST(BlackWarning, SaysWhatMayBeMissing) {
    Scene scene;
    scene.lights = {PointLight{1.0f, 1, {}}};
    EXPECT_NE(black_warning(picture(3, 4, 9), 8, scene).find("--environment studio"), std::string::npos);
    EXPECT_EQ(black_warning(picture(4, 4, 9), 8, scene), "");
    EXPECT_EQ(black_warning(picture(3, 4, 9), 7, scene), "") << "chance leaves pixels black";
    scene.lights.push_back(UniformInfiniteLight{1.0f, 1});
    EXPECT_NE(black_warning(picture(3, 4, 9), 8, scene).find("--integrator auto"), std::string::npos);
    EXPECT_EQ(black_warning(picture(3, 4, 9).select(std::vector<std::string>{"R", "G", "B"}), 8, scene), "");
    EXPECT_EQ(black_warning(picture(3, 4, 9), 8, Scene()), "") << "said when the scene was read";
}

} // namespace
} // namespace montelux
