// Goniometric and projecting lights: the picture on a wall, and how lights are turned.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <utility>
#include <vector>

#include "montelux/mc/warp/equal_area_square.h"
#include "montelux/scene/light/light_sampling.h"
#include "montelux/scene/light/projection_table.h"
#include "montelux/scene/light/visible_mean.h"
#include "montelux/scene/scene_tables.h"

namespace montelux {
namespace {

const SampledWavelengths first_wavelengths = SampledWavelengths::sample_visible(0.37f);

// Irradiance at `p` on a plane that faces light 0, at the first wavelength.
float irradiance_at(const Scene& scene, Point3f p) {
    const SceneTables tables(scene);
    const SceneView view = tables.view();
    const auto s = sample_li({view, 0}, 0, {p, {}, 1e-6f}, {0.5f, 0.5f}, first_wavelengths);
    return s ? s->radiance[0] : 0;
}

float picture_value(int x, int y) { return static_cast<float>((x * 37 + y * 11) % 17 + 1); }

Image numbered_picture(int width, int height) {
    Image image(width, height, {"R", "G", "B"});
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) image.set(x, y, c, picture_value(x, y));
    return image;
}

TEST(ProjectionLight, AWallShowsThePicture) {
    for (const auto& [width, height] : {std::pair{6, 4}, std::pair{4, 6}, std::pair{1, 1}}) {
        Scene scene;
        scene.environments = {numbered_picture(width, height)};
        scene.lights = {ProjectionLight{
            .environment = 0, .scale = 2, .fov = 60, .world_from_light = Transform::translate({0, 0, -3})}};
        const float white = RgbColorSpace::srgb().illuminant().sample(first_wavelengths)[0];
        // Half the shorter side on the wall z = 0.
        const float half = 3 * std::tan(3.14159265f / 6);
        const float texel = 2 * half / static_cast<float>(std::min(width, height));
        for (int y = -1; y <= height; ++y)
            for (int x = -1; x <= width; ++x) {
                const Point3f p{(static_cast<float>(x) + 0.5f - 0.5f * static_cast<float>(width)) * texel,
                                (static_cast<float>(y) + 0.5f - 0.5f * static_cast<float>(height)) * texel,
                                0};
                const bool beside = x < 0 || y < 0 || x == width || y == height;
                const float d2 = p.x * p.x + p.y * p.y + 9;
                const float expected = beside ? 0 : 2 * white * picture_value(x, y) / d2;
                EXPECT_NEAR(irradiance_at(scene, p), expected, 1e-4f * expected) << x << ' ' << y;
            }
        EXPECT_EQ(irradiance_at(scene, {0, 0, -6}), 0); // behind
    }
}

TEST(ProjectionLight, DirectionsAndTexels) {
    const ProjectionScreen screen(6, 4, 70);
    for (const Vec2f at : {Vec2f{0.1f, 0.2f}, Vec2f{5.9f, 3.9f}, Vec2f{3, 2}, Vec2f{0.5f, 3.5f}}) {
        const auto back = screen.locate(screen.direction(at) * 7);
        ASSERT_TRUE(back);
        EXPECT_NEAR(back->x, at.x, 1e-4);
        EXPECT_NEAR(back->y, at.y, 1e-4);
    }
    // A black picture has no directions.
    const ProjectionTable black(Image(2, 2, {"R", "G", "B"}), 50);
    EXPECT_FALSE(black.sample({0.5f, 0.5f}));
    EXPECT_EQ(black.pdf({0, 0, 1}), 0);
    EXPECT_EQ(black.flux(), 0);
}

// Where a lit texel is looked up half a texel away, or beyond the opposite edge, there are samples.
TEST(ProjectionLight, DensityFollowsTheLookup) {
    Image column(4, 1, {"R", "G", "B"});
    for (int c = 0; c < 3; ++c) column.set(0, 0, c, 1);
    const ProjectionScreen screen(4, 1, 60);
    const auto pdf = [&](PictureLookup lookup, float x) {
        return ProjectionTable(column, 60, ProjectionProfile::irradiance, lookup)
            .pdf(screen.direction({x, 0.5f}));
    };
    EXPECT_GT(pdf(PictureLookup::repeating, 3.9f), 0);
    EXPECT_EQ(pdf(PictureLookup::bilinear, 3.9f), 0);
    EXPECT_GT(pdf(PictureLookup::bilinear, 1.2f), 0);
    EXPECT_EQ(pdf(PictureLookup::nearest, 1.2f), 0);
    EXPECT_GT(pdf(PictureLookup::nearest, 0.2f), 0);
}

// The power of a grey picture: its share of the intensity times the solid angle of each texel.
TEST(ProjectionLight, PowerIsTheFlux) {
    Scene scene;
    scene.environments = {Image(48, 32, {"R", "G", "B"})};
    for (float& v : scene.environments[0].f32()) v = 2;
    scene.lights = {ProjectionLight{.environment = 0, .scale = 3, .fov = 70, .world_from_light = {}}};
    const SceneTables tables(scene);
    const SceneView view = tables.view();
    std::vector<double> powers(1);
    light_powers({view, 0}, powers);
    // A rectangle of half sides a and b at the distance 1.
    const double b = std::tan(35 * pi / 180), a = 1.5 * b;
    const double solid_angle = 4 * std::asin(a * b / std::sqrt((1 + a * a) * (1 + b * b)));
    const Spectrum white(RgbIlluminantSpectrum(RgbColorSpace::srgb(), {1, 1, 1}));
    EXPECT_NEAR(powers[0] / (2 * 3 * visible_mean(white) * solid_angle), 1, 1e-3);
}

TEST(GoniometricLight, DirectionsOfTheMap) {
    Scene scene;
    scene.environments = {numbered_picture(8, 8)};
    const Transform turned = Transform::translate({1, 2, 3}) * Transform::rotate(50, {1, 2, 0});
    scene.lights = {
        GoniometricLight{.spectrum = 1.0f, .scale = 2, .environment = 0, .world_from_map = turned}};
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            const Vec3f w = turned.vector(equal_area_square_to_sphere(
                Vec2f{(static_cast<float>(x) + 0.5f) / 8, (static_cast<float>(y) + 0.5f) / 8}));
            const float expected = 2 * picture_value(x, y) / 16;
            EXPECT_NEAR(irradiance_at(scene, Point3f(1, 2, 3) + 4 * w), expected, 1e-4f * expected);
        }
    EXPECT_EQ(irradiance_at(scene, {1, 2, 3}), 0); // at the light
}

} // namespace
} // namespace montelux
