// A million instances of one object: memory for each, and a picture.
#include "test/render/scene_testing.h"
#include <gtest/gtest.h>
#include <string_view>

namespace montelux::testing {
namespace {

// Rows of squares that face the camera, each as large as its place.
SceneBuilder field_of_instances(int side) {
    SceneBuilder b;
    const Index white = b.add(DiffuseMaterial{});
    const float half = 1.0f / static_cast<float>(side);
    TriangleMesh mesh = square(Transform::scale({half, half, 1}));
    b.add_mesh(std::move(mesh), white);
    b.scene.objects.push_back({{0}});
    b.scene.world_shapes.clear();
    b.scene.instances.reserve(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const Vec3d at{(2 * x + 1) / static_cast<double>(side) - 1,
                           (2 * y + 1) / static_cast<double>(side) - 1, 0};
            b.scene.instances.push_back({0, Transform::translate(at), no_index});
        }
    return b;
}

std::size_t bytes_of(const Renderer& renderer, std::string_view kind) {
    for (const MemoryUse& use : renderer.memory_use())
        if (use.kind == kind) return use.bytes;
    return 0;
}

// A white plane of albedo 1/2 under a uniform sky, in pieces.
void expect_plane_of_instances(int side) {
    SceneBuilder b = field_of_instances(side);
    b.add_uniform_light(1);
    b.look({0, 0, 5}, {0, 0, 0}, 20);
    b.description.integrator.max_depth = 1;
    const Renderer renderer(b.description);
    Film film(b.description.film);
    renderer.render(film);
    const PictureMean mean = picture_mean(film);
    EXPECT_NEAR(mean.mean, 0.5, 5 * mean.standard_error + 1e-4);
    const std::size_t count = b.scene.instances.size();
    const std::size_t own = bytes_of(renderer, "instances") / count,
                      tracer = bytes_of(renderer, "ray tracer") / count;
    ::testing::Test::RecordProperty("bytes_per_instance", static_cast<int>(own + tracer));
    EXPECT_LE(own, 280u);
    EXPECT_LE(tracer, 1000u);
}

TEST(Instances, AThousandMakeAPlane) { expect_plane_of_instances(32); }
TEST(InstancesSlowTest, AMillionMakeAPlane) { expect_plane_of_instances(1000); }

} // namespace
} // namespace montelux::testing
