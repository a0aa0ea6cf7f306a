// Light that path tracing lacks: how much, in scenes whose light is known, and when it matters.
#include "test/render/scene_testing.h"
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <optional>

#include "montelux/render/missing_light.h"
#include "montelux/render/render_session.h"
#include "montelux/render/render_warnings.h"

namespace montelux::testing {
namespace {

constexpr Vec3f lamp{-0.5f, 0.2f, 1}, image_of_lamp{4.5f, 0.2f, 1}; // behind the mirror x = 2

SceneBuilder floor_seen() {
    SceneBuilder b;
    b.description.film.width = b.description.film.height = 32;
    b.description.film.crop = {0, 0, 32, 32};
    b.description.integrator.max_depth = 2;
    b.add_mesh(square(Transform::scale({1.9, 1.9, 1})), b.add(DiffuseMaterial{gray(0.7f)}));
    b.look({0, -2, 3}, {0, 0, 0}, 25);
    return b;
}
void add_point(SceneBuilder& b, Vec3f at) {
    b.scene.lights.push_back(PointLight{white_light(b.scene), white_scale(), at});
}
void add_mirror(SceneBuilder& b, float roughness = 0) {
    ConductorMaterial m;
    m.metal.from_reflectance = true;
    m.metal.reflectance = gray(1);
    m.roughness = {.u = {roughness}, .v = {roughness}, .remap = false};
    b.add_mesh(square(Transform::translate({2, 0, 0}) * Transform::rotate(-90, {0, 1, 0}) *
                      Transform::scale({9, 9, 1})),
               b.add(m));
}
MissingLight missing(const SceneBuilder& b, double samples) {
    const std::optional<MissingLight> found =
        missing_light(b.description, PreparedScene(b.description), samples);
    EXPECT_TRUE(found);
    return found.value_or(MissingLight());
}

// What a mirror sends on from a point is the light of its image.
TEST(MissingLight, IsThatOfTheImageOfALampInAMirror) {
    SceneBuilder both = floor_seen(), image = floor_seen(), mirrored = floor_seen();
    add_point(both, lamp);
    add_point(both, image_of_lamp);
    add_point(image, image_of_lamp);
    add_point(mirrored, lamp);
    add_mirror(mirrored);
    for (SceneBuilder* b : {&both, &image}) b->description.sampler.spp = 1024;
    const double truth =
        picture_mean(render(image.description)).mean / picture_mean(render(both.description)).mean;
    EXPECT_GT(truth, 0.02);
    double chi2 = 0;
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        mirrored.description.sampler.seed = seed;
        const MissingLight m = missing(mirrored, 1e9);
        EXPECT_NEAR(m.never, m.share, 1e-9);
        EXPECT_EQ(m.light, 0u);
        EXPECT_LT(m.error, 0.1 * truth);
        chi2 += std::pow((m.share - truth) / m.error, 2);
        EXPECT_TRUE(m.matters(0));
        EXPECT_FALSE(m.matters(20 * truth));
    }
    EXPECT_LT(chi2, 30); // 6 degrees of freedom, errors with 63: beyond it in 1 of 10,000
}

TEST(MissingLight, RareLightIsMissingFromFewSamples) {
    SceneBuilder b = floor_seen();
    Sphere tiny;
    tiny.radius = 1e-3f;
    tiny.world_from_object = Transform::translate(Vec3d(lamp));
    b.add_quadric(tiny, b.add(DiffuseMaterial{gray(0)}), 1e6f);
    add_mirror(b);
    const MissingLight few = missing(b, 1e4), many = missing(b, 1e12);
    EXPECT_GT(few.share, 0.02);
    EXPECT_EQ(few.never, 0);
    EXPECT_TRUE(few.matters(0));
    EXPECT_LT(many.share, 1e-4);
    EXPECT_FALSE(many.matters(0));
}

TEST(MissingLight, IsNoneWherePathsFindTheLight) {
    SceneBuilder b = floor_seen();
    add_point(b, lamp);
    add_mirror(b, 0.3f);
    EXPECT_EQ(missing(b, 1e8).share, 0);
    // Nothing to look for: no surface focuses light, or another integrator.
    SceneBuilder matt = floor_seen();
    add_point(matt, lamp);
    EXPECT_FALSE(missing_light(matt.description, PreparedScene(matt.description), 1e6));
    b.description.integrator.method = IntegratorKind::bidirectional;
    EXPECT_FALSE(missing_light(b.description, PreparedScene(b.description), 1e6));
}

TEST(MissingLight, IsToldWithWhatFindsIt) {
    SceneDescription d = floor_seen().description;
    d.scene.lights = {PointLight{1.0f, 1, {}}};
    RenderSnapshot result;
    EXPECT_EQ(missing_light_warning(result, {}, d), "");
    result.missing = MissingLight{.share = 0.036, .error = 0.002, .never = 0.03, .light = 0};
    EXPECT_EQ(
        missing_light_warning(result, {}, d),
        "about 3.6 % of the light is missing: path tracing cannot find light of the point light by way of "
        "smooth surfaces; --integrator bidirectional --merging auto finds it");
    d.integrator.shading_terminator = ShadingTerminator::soft;
    result.missing->never = 0;
    EXPECT_EQ(
        missing_light_warning(result, {}, d),
        "about 3.6 % of the light is missing, or in fireflies: path tracing hardly finds light of the point "
        "light by way of smooth surfaces; --integrator bidirectional --merging auto --shading-terminator "
        "hard "
        "finds it");
    RenderTarget coarse;
    coarse.error = 0.5;
    EXPECT_EQ(missing_light_warning(result, coarse, d), "");
}

} // namespace
} // namespace montelux::testing
