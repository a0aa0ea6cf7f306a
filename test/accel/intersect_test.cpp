// Rays against the scene, compared with brute force in double precision. Nothing here is random: draws are
// fixed, and rays that pass within rounding of an edge are excluded and counted.
#include "test/accel/accel_testing.h"
#include <gtest/gtest.h>

namespace montelux::testing {
namespace {

// Aims at the unit cube from around it and from within; some rays are short, some have long directions.
Ray random_ray(Draws& draws) {
    Ray ray;
    ray.o = draws.in_cube(3);
    ray.d = normalize(draws.in_cube(1) - ray.o) * draws.uniform(0.5f, 3);
    float short_ray = draws.uniform(), t_max = draws.uniform(0, 3);
    if (short_ray < 0.3f) ray.t_max = t_max;
    return ray;
}

void expect_same_hits(Scene scene, int rays, std::uint64_t seed) {
    World world(std::move(scene));
    BruteForce reference(world.scene);
    Draws draws(seed);
    int hits = 0, close_calls = 0;
    for (int i = 0; i < rays; ++i) {
        Ray ray = random_ray(draws);
        auto expected = reference.closest(ray);
        Hit hit;
        bool found = world.accelerator.intersect(ray, hit);
        if (reference.closest_call() < 1e-5 ||
            (expected && std::abs(expected->t - double(ray.t_max)) < 1e-5 * expected->t)) {
            ++close_calls;
            continue;
        }
        ASSERT_EQ(found, expected.has_value()) << "ray " << i;
        ASSERT_EQ(world.accelerator.occluded(ray), found) << "ray " << i;
        if (!found) continue;
        ++hits;
        ASSERT_NEAR(hit.t, expected->t, 2e-5 * (1 + expected->t)) << "ray " << i;
        // Two surfaces may lie within rounding of each other.
        if (hit.shape != expected->shape || hit.primitive != expected->primitive) {
            ++close_calls;
            continue;
        }
        ASSERT_EQ(hit.instance, expected->instance) << "ray " << i;
        SurfacePoint s = surface_point(world.tables.view(), ray, hit, true);
        Vec3f p = ray.o + hit.t * ray.d;
        ASSERT_LT(length(s.p - p), 4e-5f) << "ray " << i;
        ASSERT_NEAR(length(s.ng), 1, 1e-5);
        ASSERT_EQ(s.shape, &world.scene.shapes[hit.shape]);
        // Tangents lie in the surface.
        ASSERT_LT(std::abs(dot(s.dpdu, s.ng)), 1e-3f * length(s.dpdu)) << "ray " << i;
        ASSERT_LT(std::abs(dot(s.dpdv, s.ng)), 1e-3f * length(s.dpdv)) << "ray " << i;
    }
    EXPECT_GT(hits, rays / 20);
    EXPECT_LT(close_calls, rays / 20);
}

TEST(Intersect, TriangleSoup) {
    Draws draws(1);
    Scene scene;
    add_shape(scene, soup(draws, 150, 0.4f));
    add_shape(scene, soup(draws, 50, 0.4f));
    expect_same_hits(std::move(scene), 20000, 2);
}

TEST(Intersect, WholeSpheresAndDisks) {
    Draws draws(3);
    Scene scene;
    for (int i = 0; i < 8; ++i) {
        Transform at = Transform::translate(Vec3d(draws.in_cube(1)));
        add_shape(scene,
                  Quadric(Sphere{.radius = 0.3f, .z_min = -0.3f, .z_max = 0.3f, .world_from_object = at}));
        add_shape(scene, Quadric(Disk{
                             .height = 0.1f, .radius = 0.4f, .world_from_object = draws.transform(1, true)}));
    }
    expect_same_hits(std::move(scene), 20000, 4);
}

TEST(Intersect, PartialAndTransformedQuadrics) {
    Draws draws(5);
    Scene scene;
    for (int i = 0; i < 10; ++i) {
        Transform at = draws.transform(1, i % 2 == 0), also_at = draws.transform(1, i % 2 == 1);
        float phi_max = draws.uniform(0.5f, 6), z_min = draws.uniform(-0.5f, 0),
              z_max = draws.uniform(0.05f, 0.5f);
        add_shape(scene, Quadric(Sphere{.radius = 0.5f,
                                        .z_min = z_min,
                                        .z_max = z_max,
                                        .phi_max = phi_max,
                                        .world_from_object = at}));
        add_shape(scene, Quadric(Disk{.height = z_max,
                                      .radius = 0.5f,
                                      .inner_radius = 0.2f,
                                      .phi_max = phi_max,
                                      .world_from_object = also_at}));
    }
    expect_same_hits(std::move(scene), 20000, 6);
}

TEST(Intersect, Cylinders) {
    Draws draws(11);
    Scene scene;
    for (int i = 0; i < 16; ++i)
        add_shape(scene, Quadric(Cylinder{.radius = draws.uniform(0.1f, 0.4f),
                                          .z_min = draws.uniform(-0.5f, 0),
                                          .z_max = draws.uniform(0.05f, 0.5f),
                                          .phi_max = i % 4 == 0 ? 6.2831853f : draws.uniform(0.5f, 6),
                                          .world_from_object = draws.transform(1, i % 2 == 0)}));
    expect_same_hits(std::move(scene), 20000, 12);
}

// Rays along the axis pass through the open ends; rays from within meet the wall.
TEST(Intersect, CylindersAreOpen) {
    Scene scene;
    add_shape(scene, Quadric(Cylinder{}));
    const World world(std::move(scene));
    Hit hit;
    for (const float x : {0.0f, 0.5f, 2.0f})
        EXPECT_FALSE(world.accelerator.intersect({{x, 0, -5}, {0, 0, 1}}, hit)) << x;
    ASSERT_TRUE(world.accelerator.intersect({{0, 0, 0.5f}, {-1, 0, 0}}, hit));
    EXPECT_FLOAT_EQ(hit.t, 1);
    ASSERT_TRUE(world.accelerator.intersect({{0, -3, 0.5f}, {0, 2, 0}}, hit));
    EXPECT_FLOAT_EQ(hit.t, 1);
}

TEST(Intersect, InstancesOfMeshesAndQuadrics) {
    Draws draws(7);
    Scene scene;
    add_shape(scene, soup(draws, 20, 0.3f)); // in the world itself
    for (int object = 0; object < 2; ++object) {
        ObjectDefinition definition;
        definition.shapes.push_back(add_shape(scene, soup(draws, 12, 0.5f), false));
        definition.shapes.push_back(
            add_shape(scene,
                      Quadric(Sphere{.radius = 0.4f,
                                     .z_min = -0.4f,
                                     .z_max = object == 0 ? 0.4f : 0.1f,
                                     .world_from_object = draws.transform(0.5, object == 0)}),
                      false));
        scene.objects.push_back(definition);
    }
    for (int i = 0; i < 9; ++i)
        scene.instances.push_back({static_cast<Index>(i % 2), draws.transform(0.8, i % 3 == 0)});
    expect_same_hits(std::move(scene), 20000, 8);
}

TEST(Intersect, EmptyScene) {
    World world{Scene{}};
    Hit hit;
    EXPECT_FALSE(world.accelerator.intersect({{0, 0, 0}, {0, 0, 1}}, hit));
    EXPECT_FALSE(world.accelerator.occluded({{0, 0, 0}, {0, 0, 1}}));
    EXPECT_TRUE(world.accelerator.bounds().empty());
}

TEST(Intersect, BoundsHoldEverything) {
    Draws draws(9);
    Scene scene;
    add_shape(scene, soup(draws, 30, 0.4f));
    add_shape(scene, Quadric(Sphere{.world_from_object = draws.transform(2, false)}));
    World world(std::move(scene));
    const Bounds3& b = world.accelerator.bounds();
    for (int i = 0; i < 20000; ++i) {
        Ray ray = random_ray(draws);
        Hit hit;
        if (!world.accelerator.intersect(ray, hit)) continue;
        Point3f p = surface_point(world.tables.view(), ray, hit, false).p;
        for (int c = 0; c < 3; ++c) {
            ASSERT_GE(p[c], b.lower[c] - 1e-5);
            ASSERT_LE(p[c], b.upper[c] + 1e-5);
        }
    }
}

// A ray to a point t_max away ends there: what lies behind does not hide it.
TEST(Intersect, RaysEndAtTMax) {
    Scene scene;
    add_shape(scene, Quadric(Sphere{.world_from_object = Transform::translate({0, 0, 5})}));
    World world(std::move(scene));
    Ray ray{{0, 0, 0}, {0, 0, 2}};
    for (auto [t_max, hits] : {std::pair{1.99f, false}, std::pair{2.01f, true}}) {
        ray.t_max = t_max;
        Hit hit;
        EXPECT_EQ(world.accelerator.intersect(ray, hit), hits);
        EXPECT_EQ(world.accelerator.occluded(ray), hits);
    }
}

} // namespace
} // namespace montelux::testing
