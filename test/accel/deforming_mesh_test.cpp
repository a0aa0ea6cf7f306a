// Meshes that deform: hits and their points are those of a mesh that stands still as it is at the ray's time, in the
// world and in instances, and rays that leave do not meet it again.
#include "test/accel/accel_testing.h"
#include "test/accel/still_comparison.h"
#include <gtest/gtest.h>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace montelux::testing {
namespace {

// A soup of which each vertex moves on its own, with normals, coordinates and, on request, holes that depend on the
// position; as it is at time `at` if given. In the world, in an instance and in one that moves.
Scene deforming_soup(double scale, bool holes, std::optional<float> at) {
    Draws draws(3);
    TriangleMesh mesh = soup(draws, 100, 0.6f);
    for (const Point3f p : mesh.positions) {
        mesh.end_positions.push_back(p + draws.in_cube(0.5f));
        mesh.normals.push_back(draws.direction());
        mesh.end_normals.push_back(draws.direction());
        mesh.uvs.push_back(draws.uniform_2d());
    }
    transform_mesh(mesh, Transform::scale(Vec3d{1, 1, 1} * scale));
    if (at) {
        for (Index v = 0; v < mesh.positions.size(); ++v) {
            mesh.positions[v] = mesh.position(v, *at);
            mesh.normals[v] = mesh.normal(v, *at);
        }
        mesh.end_positions.clear();
        mesh.end_normals.clear();
    }
    Scene scene;
    const Index shape = add_shape(scene, mesh), in_object = add_shape(scene, std::move(mesh), false);
    if (holes) {
        scene.float_textures.push_back(CheckerboardTexture<FloatParameter>{
            .dimension = 3, .mapping = {}, .values = {FloatParameter{0}, FloatParameter{1}}});
        for (const Index i : {shape, in_object}) scene.shapes[i].alpha = {1, 0};
    }
    scene.objects.push_back({.shapes = {in_object}});
    scene.instances.push_back({0, Transform::translate({2.5 * scale, 0, 0}) * Transform::scale({1, -1, 2})});
    const Motion motion(Transform::translate({-2.5 * scale, 0, 0}),
                        Transform::translate({-2 * scale, scale, 0}) * Transform::rotate(50, {0, 1, 1}));
    if (at) {
        scene.instances.push_back({0, motion.at(*at)});
    } else {
        scene.motions.push_back(motion);
        scene.instances.push_back({0, motion.start(), 0});
    }
    return scene;
}

TEST(DeformingMeshes, AreHitAsTheyAreAtThatTime) {
    for (const double scale : {1.0, 1e-3, 1e4})
        for (const bool holes : {false, true}) {
            if (holes && scale != 1) continue; // the pattern has a size of its own
            const World moving(deforming_soup(scale, holes, {}));
            HitCounts counts;
            ASSERT_NO_FATAL_FAILURE(compare_with_still(
                moving, [&](float time) { return deforming_soup(scale, holes, time); }, scale, 4, 6000,
                counts,
                [](const SurfacePoint& p, const SurfacePoint& q) {
                    ASSERT_NEAR(p.uv.x, q.uv.x, 1e-3f);
                    ASSERT_NEAR(p.uv.y, q.uv.y, 1e-3f);
                    ASSERT_LT(length(p.dpdu - q.dpdu), 2e-3f * length(q.dpdu));
                    ASSERT_LT(length(p.dpdv - q.dpdv), 2e-3f * length(q.dpdv));
                }));
            for (const Index instance : {no_index, Index{0}, Index{1}})
                EXPECT_GT(counts.instances[instance], counts.rays / 50) << scale;
            EXPECT_LT(counts.other, counts.rays / 500) << scale; // at edges rounding decides
        }
}

TEST(DeformingMeshes, AreBoundedAtAllTimes) {
    const World world(deforming_soup(1, false, {}));
    Bounds3 bounds;
    for (const float time : {0.0f, 0.5f, 1.0f}) {
        const Bounds3 at = bounds_of(deforming_soup(1, false, time));
        bounds.add(at.lower);
        bounds.add(at.upper);
    }
    for (const Bounds3& all : {bounds_of(world.scene), world.accelerator.bounds()}) {
        EXPECT_LE(all.lower.x, bounds.lower.x + 1e-5);
        EXPECT_LE(all.lower.y, bounds.lower.y + 1e-5);
        EXPECT_LE(all.lower.z, bounds.lower.z + 1e-5);
        EXPECT_GE(all.upper.x, bounds.upper.x - 1e-5);
        EXPECT_GE(all.upper.y, bounds.upper.y - 1e-5);
        EXPECT_GE(all.upper.z, bounds.upper.z - 1e-5);
    }
}

// A lone triangle that comes from far away: the rounding of its ends counts, not that of where it is.
TEST(DeformingMeshes, AreNotMetAgainByRaysThatLeaveThem) {
    for (const double scale : {1e-4, 1.0, 1e5})
        for (const double far : {0.0, 5.0, 1000.0}) {
            Scene scene;
            TriangleMesh mesh{.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}},
                              .normals = {},
                              .uvs = {},
                              .indices = {0, 1, 2}};
            mesh.end_positions = {{-0.7f, -1, 0.5f}, {1, 0.2f, 0}, {0.4f, 1, 0.9f}};
            const Vec3f away(Vec3d{0.3, 1, -0.7} * far);
            for (std::size_t i = 0; i < 3; ++i) {
                mesh.positions[i] += away;
                mesh.end_positions[i] -= away;
            }
            transform_mesh(mesh, Transform::scale(Vec3d{1, 1, 1} * scale));
            add_shape(scene, mesh);
            const World world(std::move(scene));
            Draws draws(17);
            const auto s = static_cast<float>(scale);
            int hits = 0, again = 0;
            for (int i = 0; i < 20000; ++i) {
                const float time = far > 100 ? draws.uniform(0.498f, 0.502f) : draws.uniform();
                const float b1 = draws.uniform(0, 0.5f), b2 = draws.uniform(0, 0.5f);
                const Vec3f towards = (1 - b1 - b2) * mesh.position(0, time) + b1 * mesh.position(1, time) +
                                      b2 * mesh.position(2, time);
                const Vec3f o = towards + s * 9 * draws.direction();
                Ray ray{o, normalize(towards - o), 1e30f, time};
                Hit hit;
                if (!world.accelerator.intersect(ray, hit)) continue;
                ++hits;
                const SurfacePoint p = surface_point(world.tables.view(), ray, hit, false);
                const Vec3f w = draws.direction();
                ray.o = offset_origin(p.p, p.ng, p.error, w);
                ray.d = w;
                again += world.accelerator.occluded(ray);
            }
            EXPECT_GT(hits, 10000) << scale << " " << far;
            EXPECT_EQ(again, 0) << scale << " " << far;
        }
}

// Rays in packets, with any others: the same bits as alone.
TEST(DeformingMeshes, AreHitByPacketsAsByRaysAlone) {
    Scene scene = deforming_soup(1, true, {});
    scene.motions.clear(); // nothing but the mesh moves
    scene.instances[1].motion = no_index;
    const World world(std::move(scene));
    Draws draws(23);
    std::vector<Ray> rays;
    for (int i = 0; i < 5003; ++i) {
        const Vec3f o = draws.in_cube(4), d = draws.direction();
        rays.push_back({o, d, 1e30f, draws.uniform()});
    }
    std::vector<const Ray*> pointers;
    for (const Ray& ray : rays) pointers.push_back(&ray);
    std::vector<Hit> hits(rays.size());
    world.accelerator.intersect(pointers, hits);
    const auto results = std::make_unique<bool[]>(rays.size());
    world.accelerator.occluded(pointers, std::span(results.get(), rays.size()));
    int found = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        Hit alone;
        const bool hit = world.accelerator.intersect(rays[i], alone);
        ASSERT_EQ(hit, hits[i].shape != no_index) << i;
        ASSERT_EQ(world.accelerator.occluded(rays[i]), results[i]) << i;
        if (!hit) continue;
        ++found;
        ASSERT_EQ(alone.t, hits[i].t);
        ASSERT_EQ(alone.b1, hits[i].b1);
        ASSERT_EQ(alone.b2, hits[i].b2);
        ASSERT_EQ(alone.shape, hits[i].shape);
        ASSERT_EQ(alone.primitive, hits[i].primitive);
        ASSERT_EQ(alone.instance, hits[i].instance);
    }
    EXPECT_GT(found, 300);
}

} // namespace
} // namespace montelux::testing
