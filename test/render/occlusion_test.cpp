// Ambient occlusion against closed forms.
#include "test/render/scene_testing.h"
#include <gtest/gtest.h>

#include "montelux/mc/math/constants.h"

namespace montelux::testing {
namespace {

// The floor below a sphere, seen at one point.
SceneDescription floor_below_sphere(double radius, double height, OcclusionSettings settings) {
    SceneBuilder b;
    b.add_mesh(square(Transform::scale({50, 50, 1})), b.add(DiffuseMaterial{gray(0.2f)}));
    Sphere sphere;
    sphere.radius = static_cast<float>(radius);
    sphere.z_min = -sphere.radius;
    sphere.z_max = sphere.radius;
    sphere.world_from_object = Transform::translate({0, 0, height});
    b.add_quadric(sphere, b.add(DiffuseMaterial{gray(0.8f)}));
    b.look({0.05, 0, 0.02}, {0, 0, 0}, 0.1f);
    b.description.integrator.occlusion = settings;
    b.description.sampler.spp = 512;
    return b.description;
}

// A sphere of radius r above a point of the floor, its centre at height h, hides (r / h)^2 of the cosine-weighted
// hemisphere.
TEST(AmbientOcclusion, OfASphereAboveAFloor) {
    for (const bool cosine : {true, false}) {
        const PictureMean m = picture_mean(render(floor_below_sphere(1, 2, {.cosine = cosine})));
        EXPECT_NEAR(m.mean, 0.75, 5.5 * m.standard_error + 1e-4) << cosine;
        const PictureMean open =
            picture_mean(render(floor_below_sphere(1, 2, {.cosine = cosine, .max_distance = 0.99f})));
        EXPECT_NEAR(open.mean, 1, 5.5 * open.standard_error + 1e-4) << cosine;
    }
}

// With a limit of d the sphere hides what lies nearer: the cap where the distance to it is below d, whose edge has
// cos(theta) = (h^2 + d^2 - r^2) / (2 h d).
TEST(AmbientOcclusion, EndsAtTheMaximumDistance) {
    const double r = 1, h = 2, d = 1.2, c = (h * h + d * d - r * r) / (2 * h * d);
    SceneDescription scene = floor_below_sphere(r, h, {.max_distance = static_cast<float>(d)});
    const PictureMean m = picture_mean(render(scene));
    EXPECT_NEAR(m.mean, c * c, 5.5 * m.standard_error + 1e-4);
    // The distance is that from the floor, with an interface on the way as well.
    CallMessages messages("scene of a test");
    scene.scene.materials.push_back(InterfaceMaterial{});
    montelux::SceneBuilder(scene.scene, messages)
        .add_shape(square(Transform::translate({0, 0, 0.4}) * Transform::scale({9, 9, 1})), {.material = 2});
    const PictureMean through = picture_mean(render(scene));
    EXPECT_NEAR(through.mean, c * c, 5.5 * through.standard_error + 1e-4);
}

// The sphere has moved away when the shutter opens.
TEST(AmbientOcclusion, SeesTheSceneAtTheTimeOfTheSample) {
    SceneDescription d = floor_below_sphere(1, 2, {});
    d.scene.world_shapes = {0};
    d.scene.objects.push_back({.shapes = {1}});
    d.scene.motions.emplace_back(Transform(), Transform::translate({0, 0, 1e6}));
    d.scene.instances.push_back({0, Transform(), 0});
    d.scene.camera.shutter_open = 1;
    d.scene.camera.shutter_close = 2;
    const PictureMean m = picture_mean(render(d));
    EXPECT_NEAR(m.mean, 1, 5.5 * m.standard_error + 1e-4);
}

TEST(AmbientOcclusion, InterfacesAndLightsDoNotMatter) {
    SceneDescription bare = floor_below_sphere(1, 2, {}), d = bare;
    d.scene.materials.push_back(InterfaceMaterial{});
    d.scene.materials[1] = InterfaceMaterial{}; // the sphere's
    const PictureMean m = picture_mean(render(d));
    EXPECT_NEAR(m.mean, 1, 5.5 * m.standard_error + 1e-4);
    d.scene.lights.push_back(UniformInfiniteLight{white_light(d.scene), 100});
    const PictureMean lit = picture_mean(render(d));
    EXPECT_EQ(lit.mean, m.mean);
    // Through an interface the camera sees the floor, and what is behind the background is black.
    bare.scene.camera.world_from_camera = Transform::look_at({0, 0, 60}, {0, 0, 100}, {0, 1, 0})->inverse();
    EXPECT_EQ(picture_mean(render(bare)).mean, 0);
}

} // namespace
} // namespace montelux::testing
