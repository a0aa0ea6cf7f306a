// Area lights with holes: all strategies find the same light. Each comparison is at 5 standard errors (a
// false alarm in 1.7 million) plus rounding.
#include "test/render/scene_testing.h"
#include <gtest/gtest.h>

namespace montelux::testing {
namespace {

constexpr Strategy every_strategy[] = {Strategy::uniform, Strategy::bsdf, Strategy::light, Strategy::mis};
constexpr double floor_albedo = 0.6;

// A floor of floor_albedo, seen at the origin by one bounce.
SceneBuilder floor_below(const Quadric& light, FloatParameter alpha) {
    SceneBuilder b;
    b.add_mesh(square(Transform::scale({100, 100, 1})),
               b.add(DiffuseMaterial{gray(static_cast<float>(floor_albedo))}));
    const Index shape = b.add_quadric(light, b.add(DiffuseMaterial{gray(0)}), 4, true);
    b.scene.shapes[shape].alpha = alpha;
    b.description.integrator.max_depth = 1;
    b.description.sampler.spp = 1024;
    b.look({0, -0.5, 1}, {0, 0, 0}, 0.05f);
    return b;
}

void expect_radiance(SceneBuilder& b, double truth, const std::string& what) {
    for (Strategy s : every_strategy) {
        b.description.integrator.strategy = s;
        const PictureMean m = picture_mean(render(b.description));
        EXPECT_NEAR(m.mean, truth, 5 * m.standard_error + 2e-4 * truth)
            << what << ", strategy " << static_cast<int>(s);
        EXPECT_GT(m.mean, 0.5 * truth); // even where the error is large
    }
}

TEST(CutOutLights, ShineWithTheShareThatIsThere) {
    // A disc of radius r at height h over the point: form factor r^2 / (r^2 + h^2).
    const Disk disc{.radius = 2, .world_from_object = Transform::translate({0, 0, 3})};
    const double whole = floor_albedo * 4 * 4.0 / 13;
    SceneBuilder half = floor_below(disc, {0.5f});
    expect_radiance(half, 0.5 * whole, "alpha 0.5");
    SceneBuilder textured = floor_below(disc, {0.25f});
    textured.scene.float_textures.push_back(ConstantTexture<FloatParameter>{FloatParameter{0.25f}});
    textured.scene.shapes.back().alpha = {0, 0};
    expect_radiance(textured, 0.25 * whole, "a texture that is constant");
}

TEST(CutOutLights, HolesAreDark) {
    // The alpha is 1 within radius 1 of the disc and 0 outside: v goes from 1 at the centre to 0 at the rim.
    SceneBuilder b =
        floor_below(Disk{.radius = 2, .world_from_object = Transform::translate({0, 0, 3})}, {1});
    Image ring(1, 2, {"Y"});
    ring.set(0, 0, 0, 1);
    b.scene.images.push_back(ring);
    ImageTexture t;
    t.image = 0;
    t.filter = TextureFilter::point;
    t.wrap = TextureWrap::clamp;
    b.scene.float_textures.push_back(t);
    b.scene.shapes.back().alpha = {0, 0};
    expect_radiance(b, floor_albedo * 4 * 1.0 / 10, "a ring");
}

// As in pbrt-v4: with alpha 0 a light emits fully, and no ray hits it.
TEST(CutOutLights, OfAlphaZeroShineAndAreNotSeen) {
    const Disk disc{.radius = 2, .world_from_object = Transform::translate({0, 0, 3})};
    SceneBuilder b = floor_below(disc, {0});
    expect_radiance(b, floor_albedo * 4 * 4.0 / 13, "alpha 0");
    b.scene.float_textures.push_back(ConstantTexture<FloatParameter>{FloatParameter{0}});
    b.scene.shapes.back().alpha = {1, 0};
    b.scene.shapes.back().alpha.texture = 0;
    expect_radiance(b, floor_albedo * 4 * 4.0 / 13, "a texture of 0");
    b.look({0, -0.5, 1}, {0, 0, 3}, 5);
    for (Strategy s : every_strategy) {
        b.description.integrator.strategy = s;
        EXPECT_EQ(picture_mean(render(b.description)).mean, 0);
    }
}

// Through the near side of a sphere its inside is seen.
TEST(CutOutLights, SpheresShineFromBothSides) {
    for (bool two_sided : {false, true}) {
        std::vector<PictureMean> means;
        for (Strategy s : every_strategy) {
            SceneBuilder b =
                floor_below(Sphere{.world_from_object = Transform::translate({0, 0, 4})}, {0.4f});
            b.scene.shapes.back().flip_normal = false;
            std::get<AreaLight>(b.scene.lights[0]).two_sided = two_sided;
            b.description.integrator.strategy = s;
            b.description.sampler.spp = 1024;
            means.push_back(picture_mean(render(b.description)));
        }
        // Of the light behind it the near side lets 0.6 through.
        const double truth = floor_albedo * 4 / 16 * (two_sided ? 0.4 + 0.6 * 0.4 : 0.4);
        for (const PictureMean& m : means)
            EXPECT_NEAR(m.mean, truth, 5 * m.standard_error + 2e-4 * truth) << two_sided;
    }
}

} // namespace
} // namespace montelux::testing
