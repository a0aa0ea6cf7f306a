// Cameras and lights of glTF.
#include "test/formats/gltf/model.h"
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/math/constants.h"
#include "montelux/spectrum/cie.h"

namespace montelux {
namespace {

using test::load_model;
using test::model_error;

std::string scene(const std::string& members) { return R"({"asset": {"version": "2.0"}, )" + members + "}"; }

const std::string two_cameras =
    R"("cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}},
    {"type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2, "zfar": 9, "znear": 0}}],
    "nodes": [{"camera": 0, "name": "front", "translation": [0, 0, 5]}, {"camera": 1, "name": "plan"}])";

TEST(GltfCameras, Perspective) {
    const SceneDescription d = load_model(scene(two_cameras));
    EXPECT_TRUE(d.has_camera);
    const auto& camera = std::get<PerspectiveCamera>(d.scene.camera.model);
    EXPECT_NEAR(camera.fov, 180 / pi, 1e-4);
    EXPECT_EQ(d.film.width, 800);
    EXPECT_EQ(d.film.height, 600);
    // Looks along -z, with x to the right.
    const Transform& t = d.scene.camera.world_from_camera;
    EXPECT_EQ(t.point(Point3f(0, 0, 0)), Point3f(0, 0, 5));
    EXPECT_EQ(t.vector(Vec3f(0, 0, 1)), Vec3f(0, 0, -1));
    EXPECT_EQ(t.vector(Vec3f(1, 0, 0)), Vec3f(1, 0, 0));
    EXPECT_EQ(t.vector(Vec3f(0, 1, 0)), Vec3f(0, 1, 0));
}

TEST(GltfCameras, TheFilmFollowsTheAspectRatio) {
    const auto film = [](const std::string& aspect) {
        return load_model(scene(R"("cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1,
            "aspectRatio": )" + aspect +
                                R"(}}], "nodes": [{"camera": 0, "scale": [2, 2, 2]}])"));
    };
    const SceneDescription wide = film("2"), high = film("0.5");
    EXPECT_EQ(wide.film.width, 800);
    EXPECT_EQ(wide.film.height, 400);
    EXPECT_EQ(high.film.width, 400);
    EXPECT_EQ(high.film.height, 800);
    EXPECT_EQ(high.film.crop.x1, 400);
    // The angle is that of the shorter side, and the node's scale has no effect.
    EXPECT_NEAR(std::get<PerspectiveCamera>(high.scene.camera.model).fov,
                2 * std::atan(std::tan(0.5) / 2) * 180 / pi, 1e-4);
    EXPECT_EQ(high.scene.camera.world_from_camera.vector(Vec3f(0, 0, 1)), Vec3f(0, 0, -1));
}

TEST(GltfCameras, AreChosenByNameOrNumber) {
    for (const char* name : {"plan", "1"}) {
        const SceneDescription d = load_model(scene(two_cameras), nullptr, {.camera = name});
        const auto& camera = std::get<OrthographicCamera>(d.scene.camera.model);
        EXPECT_EQ(camera.scale, 2);
        EXPECT_FALSE(camera.screen_window); // pixels stay square at other sizes
        EXPECT_EQ(d.film.width, 800);
        EXPECT_EQ(d.film.height, 533);
    }
    EXPECT_EQ(model_error(scene(two_cameras), {.camera = "plam"}),
              "there is no camera 'plam' (did you mean 'plan'?); expected 0 'front', 1 'plan'");
    EXPECT_EQ(model_error(scene(R"("nodes": [])"), {.camera = "0"}),
              "there is no camera '0'; the scene has none");
}

SceneDescription lit(const std::string& light) {
    return load_model(scene(R"("extensions": {"KHR_lights_punctual": {"lights": [)" + light + R"(]}},
        "nodes": [{"translation": [1, 2, 3], "rotation": [0.70710678, 0, 0, 0.70710678],
                   "extensions": {"KHR_lights_punctual": {"light": 0}}}])"));
}

// The luminance of white light, times its scale, is the intensity in cd or the illuminance in lx.
double photometric(const SceneDescription& d, SceneSpectrum s, float scale) {
    return to_photometric(spectrum_of(s, d.scene.spectra)) * double(scale);
}

TEST(GltfLights, CandelaAndLux) {
    SceneDescription d = lit(R"({"type": "point", "intensity": 40})");
    const auto& point = std::get<PointLight>(d.scene.lights.at(0));
    EXPECT_EQ(point.position, Point3f(1, 2, 3));
    EXPECT_NEAR(photometric(d, point.spectrum, point.scale), 40, 1e-3);
    d = lit(R"({"type": "directional", "intensity": 3, "color": [1, 0.5, 0]})");
    const auto& distant = std::get<DistantLight>(d.scene.lights.at(0));
    EXPECT_NEAR(photometric(d, distant.spectrum, distant.scale), 3, 1e-4);
    EXPECT_NEAR(distant.to_light.y, -1,
                1e-6); // along -z, turned by 90 degrees around x: light travels along +y
    d = lit(R"({"type": "spot", "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.2}})");
    const auto& spot = std::get<SpotLight>(d.scene.lights.at(0));
    EXPECT_NEAR(photometric(d, spot.spectrum, spot.scale), 1, 1e-5);
    EXPECT_NEAR(spot.axis.y, 1, 1e-6);
    EXPECT_FLOAT_EQ(spot.cos_falloff_start, std::cos(0.1f));
    EXPECT_FLOAT_EQ(spot.cos_total_width, std::cos(0.2f));
}

} // namespace
} // namespace montelux
