// Moving instances: hits lie on the surface at the ray's time, leave it without meeting it again, and are those
// of a scene that stands still at that time.
#include "test/accel/accel_testing.h"
#include "test/accel/still_comparison.h"
#include <gtest/gtest.h>
#include <vector>

namespace montelux::testing {
namespace {

struct MovingWorld {
    // As scene(t), with a motion instead.
    static Scene moving(double scale) {
        Scene scene = objects();
        scene.motions = motions(scale);
        for (Index i = 0; i < scene.motions.size(); ++i)
            scene.instances.push_back({0, scene.motions[i].start(), i});
        return scene;
    }
    static Scene still(double scale, float t) {
        Scene scene = objects();
        for (const Motion& motion : motions(scale)) scene.instances.push_back({0, motion.at(t)});
        return scene;
    }

  private:
    static Scene objects() {
        Scene scene;
        Draws draws(3);
        const Index mesh = add_shape(scene, soup(draws, 100, 0.6f), false);
        const Index sphere = add_shape(
            scene, Quadric(Sphere{.radius = 0.3f, .z_min = -0.3f, .z_max = 0.3f, .world_from_object = {}}),
            false);
        scene.objects.push_back({.shapes = {mesh, sphere}});
        return scene;
    }
    static std::vector<Motion> motions(double scale) {
        Draws draws(5);
        const Transform unit = Transform::scale(Vec3d{1, 1, 1} * scale);
        std::vector<Motion> motions;
        for (int i = 0; i < 4; ++i) {
            const Transform a = draws.transform(1, false), b = draws.transform(1, false);
            if (a.swaps_handedness() == b.swaps_handedness())
                motions.emplace_back(unit * a, unit * b);
            else
                motions.emplace_back(unit * a, unit * b * Transform::scale({-1, 1, 1}));
        }
        return motions;
    }
};

TEST(MovingInstances, AreHitWhereTheyAreAtThatTime) {
    for (const double scale : {1.0, 1e-3, 1e4}) {
        const World moving(MovingWorld::moving(scale));
        HitCounts counts;
        ASSERT_NO_FATAL_FAILURE(compare_with_still(
            moving, [&](float time) { return MovingWorld::still(scale, time); }, scale, 3, 4000, counts,
            [](const SurfacePoint&, const SurfacePoint&) {}));
        EXPECT_GT(counts.hits(), counts.rays / 10) << scale;
        EXPECT_LT(counts.other, counts.rays / 500) << scale; // at edges rounding decides
    }
}

// A ray that leaves to the other side of a lone triangle or the outside of a lone sphere meets nothing.
TEST(MovingInstances, AreNotMetAgainByRaysThatLeaveThem) {
    for (const double scale : {1e-4, 1.0, 1e5})
        for (const bool is_sphere : {false, true}) {
            Scene scene;
            const Index shape =
                is_sphere ? add_shape(scene, Quadric(Sphere{.world_from_object = {}}), false)
                          : add_shape(scene,
                                      TriangleMesh{.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}},
                                                   .normals = {},
                                                   .uvs = {},
                                                   .indices = {0, 1, 2}},
                                      false);
            scene.objects.push_back({.shapes = {shape}});
            const Transform unit = Transform::scale(Vec3d{1, 1, 1} * scale);
            scene.motions.emplace_back(unit * Transform::translate({3, 0, 0}),
                                       unit * Transform::translate({-2, 7, 1}) *
                                           Transform::rotate(100, {1, 1, 1}));
            scene.instances.push_back({0, scene.motions[0].start(), 0});
            const World world(std::move(scene));
            Draws draws(17);
            const auto s = static_cast<float>(scale);
            int hits = 0, again = 0;
            for (int i = 0; i < 20000; ++i) {
                const float time = draws.uniform();
                const Vec3f towards =
                    Vec3f(world.scene.motions[0].at(time).point(Vec3d(0.7f * draws.in_cube(1))));
                const Vec3f o = s * 9 * draws.direction();
                Ray ray{o, normalize(towards - o), 1e30f, time};
                Hit hit;
                if (!world.accelerator.intersect(ray, hit)) continue;
                ++hits;
                const SurfacePoint p = surface_point(world.tables.view(), ray, hit, false);
                Vec3f w = draws.direction();
                if (is_sphere && dot(w, p.ng) < 0) w = -w;
                ray.o = offset_origin(p.p, p.ng, p.error, w);
                ray.d = w;
                again += world.accelerator.occluded(ray);
            }
            EXPECT_GT(hits, 5000) << scale;
            EXPECT_EQ(again, 0) << scale << " " << is_sphere;
        }
}

} // namespace
} // namespace montelux::testing
