// The footprints of pixels in texture coordinates.
#include <gtest/gtest.h>

#include "montelux/scene/camera/camera.h"
#include "montelux/scene/scene.h"
#include "montelux/scene/shape/surface_point.h"
#include "montelux/transport/texture_footprint.h"

namespace montelux {
namespace {

// A pixel's step covers as much of the second set as the set says of the plane.
TEST(TextureFootprint, FollowsTheSetOfCoordinates) {
    Scene scene;
    TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 0}, {1, 0}, {0, 1}}, {0, 1, 2}};
    mesh.second_uvs = {{0, 0}, {0, -2}, {4, 0}}; // (4 y, -2 x); the first set is (x, y)
    scene.meshes = {mesh};
    scene.shapes = {{.geometry = MeshIndex{0}}};
    CameraSettings settings;
    settings.world_from_camera = Transform::translate({0, 0, 5}) * Transform::rotate(180, {0, 1, 0});
    const Camera camera(settings, 640, 480);
    const Ray down{{0.25f, 0.5f, 1}, {0, 0, -1}};
    Hit hit;
    hit.t = 1;
    hit.b1 = 0.25f;
    hit.b2 = 0.5f;
    hit.shape = 0;
    const SurfacePoint s = surface_point(SceneView(scene), down, hit, true);
    const TextureContext c = texture_context(camera, 1, s);
    ASSERT_GT(length(c.duvdx), 0);
    EXPECT_NEAR(c.second_duvdx.x, 4 * c.duvdx.y, 1e-6f);
    EXPECT_NEAR(c.second_duvdx.y, -2 * c.duvdx.x, 1e-6f);
    EXPECT_NEAR(c.second_duvdy.x, 4 * c.duvdy.y, 1e-6f);
    EXPECT_NEAR(c.second_duvdy.y, -2 * c.duvdy.x, 1e-6f);
}

} // namespace
} // namespace montelux
