// Bilinear patches in Embree's hierarchy against all of them one by one, and the points of their surfaces.
// Nothing is random: draws are fixed.
#include "test/accel/accel_testing.h"
#include <gtest/gtest.h>

namespace montelux::testing {
namespace {

BilinearMesh some_patches(Draws& draws, int count, float size) {
    BilinearMesh mesh;
    for (int i = 0; i < count; ++i) {
        const Vec3f place = draws.in_cube(1);
        for (int k = 0; k < 4; ++k) {
            mesh.indices.push_back(static_cast<Index>(mesh.positions.size()));
            mesh.positions.push_back(place + draws.in_cube(size));
        }
    }
    return mesh;
}

struct Nearest {
    PatchHit hit{1e30, 0, 0};
    Index shape = no_index, primitive = 0, instance = no_index;
};
void meet(const Scene& scene, Index shape, Index instance, const Ray& ray, Nearest& nearest) {
    const BilinearMesh& mesh = *bilinear_mesh_of(scene, scene.shapes[shape]);
    for (std::size_t i = 0; i < mesh.patch_count(); ++i)
        if (const auto hit = intersect(mesh.patch(i), Vec3d(ray.o), Vec3d(ray.d), 0, nearest.hit.t))
            nearest = {*hit, shape, static_cast<Index>(i), instance};
}

TEST(BilinearMeshes, RaysMeetTheNearestPatch) {
    Draws draws(41);
    Scene built;
    add_shape(built, some_patches(draws, 300, 0.2f));
    add_shape(built, some_patches(draws, 3, 1));
    built.objects.push_back({.shapes = {add_shape(built, some_patches(draws, 20, 0.4f), false)}});
    for (int i = 0; i < 2; ++i)
        built.instances.push_back({.object = 0, .world_from_object = draws.transform(1, false)});
    const World world(std::move(built));
    int hits = 0, on_instances = 0, other = 0;
    for (int i = 0; i < 5000; ++i) {
        Ray ray;
        ray.o = draws.in_cube(3);
        ray.d = normalize(draws.in_cube(1) - ray.o) * draws.uniform(0.5f, 3);
        if (i % 4 == 0) ray.t_max = draws.uniform(0, 3);
        Nearest expected;
        expected.hit.t = ray.t_max;
        for (const Index shape : world.scene.world_shapes) meet(world.scene, shape, no_index, ray, expected);
        for (std::size_t k = 0; k < world.scene.instances.size(); ++k) {
            const Transform inverse = world.scene.instances[k].world_from_object.inverse();
            Ray local = ray;
            local.o = inverse.point(ray.o);
            local.d = inverse.vector(ray.d);
            meet(world.scene, world.scene.objects[0].shapes[0], static_cast<Index>(k), local, expected);
        }
        Hit hit;
        const bool found = world.accelerator.intersect(ray, hit);
        ASSERT_EQ(world.accelerator.occluded(ray), found) << i;
        if (found != (expected.shape != no_index) || (found && hit.primitive != expected.primitive)) {
            ++other; // at an edge: Embree transforms rays otherwise than we do
            continue;
        }
        if (!found) continue;
        ++hits;
        on_instances += hit.instance != no_index;
        EXPECT_EQ(hit.shape, expected.shape);
        EXPECT_EQ(hit.instance, expected.instance);
        EXPECT_NEAR(hit.t, expected.hit.t, 1e-4 * (1 + expected.hit.t));
        const SurfacePoint s = surface_point(world.tables.view(), ray, hit, true);
        EXPECT_LT(length(s.p - (ray.o + hit.t * ray.d)), 2e-5f);
        EXPECT_LT(std::abs(s.uv.x - hit.b1) + std::abs(s.uv.y - hit.b2), 1e-6f);
        EXPECT_NEAR(dot(s.ng, normalize(s.dpdu)), 0, 1e-4f);
        EXPECT_NEAR(dot(s.ng, normalize(s.dpdv)), 0, 1e-4f);
    }
    EXPECT_LE(other, 4);
    EXPECT_GT(hits, 2000);
    EXPECT_GT(on_instances, 100);
}

// Coordinates and normals at vertices, and a way out: a ray that leaves does not start behind its own patch.
TEST(BilinearMeshes, PointsOfTheirSurfaces) {
    BilinearMesh mesh;
    mesh.positions = {{100, 0, 0}, {101, 0, 0}, {100, 1, 0}, {101, 1, 0.3f}};
    mesh.indices = {0, 1, 2, 3};
    mesh.uvs = {{1, 1}, {3, 1}, {1, 4}, {3, 4}};
    mesh.normals = {{0, 0, -1}, {0.1f, 0, -1}, {0, 0.1f, -1}, {0, 0, -1}};
    Scene built;
    add_shape(built, mesh);
    const World world(std::move(built));
    Draws draws(42);
    int hits = 0;
    for (int i = 0; i < 1000; ++i) {
        Ray ray;
        ray.o = {100.5f, 0.5f, i % 2 == 0 ? 3.0f : -3.0f};
        ray.d = normalize(Vec3f{draws.uniform(100, 101), draws.uniform(0, 1), 0} - ray.o);
        Hit hit;
        if (!world.accelerator.intersect(ray, hit)) continue;
        ++hits;
        const SurfacePoint s = surface_point(world.tables.view(), ray, hit, true);
        const float x = s.p.x - 100, y = s.p.y;
        EXPECT_NEAR(s.uv.x, 1 + 2 * x, 1e-4f);
        EXPECT_NEAR(s.uv.y, 1 + 3 * y, 1e-4f);
        EXPECT_LT(length(s.dpdu - Vec3f{0.5f, 0, 0.15f * y}), 1e-4f);
        EXPECT_LT(length(s.dpdv - Vec3f{0, 1.0f / 3, 0.1f * x}), 1e-4f);
        const Vec3f expected = normalize(Vec3f{0.1f * x * (1 - y), 0.1f * y * (1 - x), -1});
        EXPECT_LT(length(s.ns - expected), 1e-4f);
        EXPECT_LT(s.ng.z, 0); // on the side of the vertex normals
        // The patch is nearly flat: away from it on the side of the ray nothing is met.
        const Vec3f w = ray.d * -1.0f;
        Ray leaving;
        leaving.o = offset_origin(s.p, s.ng, s.error, w);
        leaving.d = w;
        EXPECT_FALSE(world.accelerator.occluded(leaving)) << i;
        leaving.o = offset_origin(s.p, s.ng, s.error, ray.d);
        leaving.d = ray.d;
        EXPECT_FALSE(world.accelerator.occluded(leaving)) << i;
    }
    EXPECT_GT(hits, 900);
}

} // namespace
} // namespace montelux::testing
