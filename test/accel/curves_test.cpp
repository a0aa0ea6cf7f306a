// Curves in Embree's hierarchy against all of their segments one by one, and the points of their surfaces.
// Nothing is random: draws are fixed.
#include "test/accel/accel_testing.h"
#include "test/sanitized.h"
#include <array>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/accel/curve_pieces.h"

namespace montelux::testing {
namespace {

Curves some_curves(Draws& draws, Curves::Kind kind, int segments, float width) {
    Curves curves;
    curves.kind = kind;
    for (int i = 0; i < segments; ++i) {
        const Vec3f start = draws.in_cube(1);
        auto& points = curves.control_points.emplace_back();
        for (Point3f& p : points) p = start + draws.in_cube(0.7f);
        curves.widths.push_back({draws.uniform(0, width), draws.uniform(0, width)});
        if (kind == Curves::Kind::ribbon) curves.normals.push_back({draws.direction(), draws.direction()});
    }
    return curves;
}

Scene scene_of_curves() {
    Draws draws(21);
    Scene scene;
    add_shape(scene, some_curves(draws, Curves::Kind::flat, 40, 0.1f));
    add_shape(scene, some_curves(draws, Curves::Kind::cylinder, 40, 0.1f));
    add_shape(scene, some_curves(draws, Curves::Kind::ribbon, 40, 0.1f));
    scene.objects.push_back(
        {.shapes = {add_shape(scene, some_curves(draws, Curves::Kind::flat, 20, 0.2f), false)}});
    for (int i = 0; i < 2; ++i)
        scene.instances.push_back({.object = 0, .world_from_object = draws.transform(1, false)});
    return scene;
}

// Of all pieces of the shape.
void meet(const Scene& scene, Index shape, Index instance, const Ray& ray, Hit& nearest) {
    const Curves& curves = *curves_of(scene, scene.shapes[shape]);
    const CurvePieces pieces = curve_pieces(curves);
    for (std::size_t piece = 0; piece < curves.segment_count() << pieces.levels; ++piece) {
        const auto hit = intersect(curves.segment(pieces.segment(piece)), Vec3d(ray.o), Vec3d(ray.d), 0,
                                   double(nearest.t), pieces.range(piece));
        if (hit)
            nearest = {static_cast<float>(hit->t),
                       static_cast<float>(hit->u),
                       static_cast<float>(hit->v),
                       shape,
                       static_cast<Index>(pieces.segment(piece)),
                       instance};
    }
}

TEST(Curves, RaysMeetTheNearestSegment) {
    const World world(scene_of_curves());
    Draws draws(22);
    std::array<int, 4> hits{};
    int on_instances = 0, other = 0;
    const int rays = under_sanitizers ? 1000 : 4000;
    for (int i = 0; i < rays; ++i) {
        Ray ray;
        ray.o = draws.in_cube(3);
        ray.d = normalize(draws.in_cube(1) - ray.o) * draws.uniform(0.5f, 3);
        if (i % 4 == 0) ray.t_max = draws.uniform(0, 3);
        Hit expected;
        expected.t = ray.t_max;
        for (const Index shape : world.scene.world_shapes) meet(world.scene, shape, no_index, ray, expected);
        for (std::size_t k = 0; k < world.scene.instances.size(); ++k) {
            const Instance& instance = world.scene.instances[k];
            const Transform inverse = instance.world_from_object.inverse();
            Ray local = ray;
            local.o = inverse.point(ray.o);
            local.d = inverse.vector(ray.d);
            meet(world.scene, world.scene.objects[0].shapes[0], static_cast<Index>(k), local, expected);
        }
        Hit hit;
        const bool found = world.accelerator.intersect(ray, hit);
        ASSERT_EQ(world.accelerator.occluded(ray), found) << i;
        // Embree transforms rays otherwise than we do: one in thousands passes an edge.
        if (found != (expected.shape != no_index) || (found && hit.primitive != expected.primitive)) {
            ++other;
            continue;
        }
        if (!found) continue;
        ++hits[hit.shape];
        on_instances += hit.instance != no_index;
        EXPECT_EQ(hit.shape, expected.shape);
        EXPECT_EQ(hit.instance, expected.instance);
        EXPECT_NEAR(hit.t, expected.t, 1e-5f * (1 + expected.t));
        EXPECT_NEAR(hit.b1, expected.b1, 1e-3f);
        EXPECT_NEAR(hit.b2, expected.b2, 1e-3f);
    }
    EXPECT_LE(other, 4);
    for (const int n : hits) EXPECT_GT(n, rays / 40);
    EXPECT_GT(on_instances, rays / 40);
}

TEST(Curves, LongDiagonalsAreSplit) {
    Curves curves;
    curves.control_points = {{Point3f{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}};
    curves.widths = {{0.01f, 0.01f}};
    EXPECT_EQ(curve_pieces(curves).levels, 3u);
    EXPECT_EQ(curve_pieces(curves).segment(15), 1u);
    EXPECT_EQ(curve_pieces(curves).range(15).u0, 0.875);
    EXPECT_EQ(curve_pieces(curves).range(15).u1, 1);
    curves.control_points[0] = {Point3f{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}; // a box fits it
    EXPECT_EQ(curve_pieces(curves).levels, 0u);
}

// Tangents along and across, normals towards the ray, and a way out: the ray that leaves does not meet its own
// straight segment again.
TEST(Curves, PointsOfTheirSurfaces) {
    for (const Curves::Kind kind : {Curves::Kind::flat, Curves::Kind::cylinder, Curves::Kind::ribbon}) {
        Scene built;
        Curves curves;
        curves.kind = kind;
        curves.control_points = {{Point3f{-1, 0, 0}, {-1.0f / 3, 0, 0}, {1.0f / 3, 0, 0}, {1, 0, 0}}};
        curves.widths = {{0.2f, 0.2f}};
        const Vec3f up = normalize(Vec3f{0, 1, 1});
        if (kind == Curves::Kind::ribbon) curves.normals = {{up, up}};
        add_shape(built, curves);
        const World world(std::move(built));
        Draws draws(23);
        int hits = 0;
        for (int i = 0; i < 1000; ++i) {
            Ray ray;
            ray.o = normalize(draws.in_cube(1)) * 3.0f;
            ray.d = normalize(Vec3f{draws.uniform(-0.9f, 0.9f), draws.uniform(-0.05f, 0.05f),
                                    draws.uniform(-0.05f, 0.05f)} -
                              ray.o);
            Hit hit;
            if (!world.accelerator.intersect(ray, hit)) continue;
            ++hits;
            const SurfacePoint s = surface_point(world.tables.view(), ray, hit, true);
            EXPECT_LT(length(s.p - (ray.o + hit.t * ray.d)), 1e-5f);
            EXPECT_NEAR(s.uv.x, 0.5f * (s.p.x + 1), 1e-4f);
            EXPECT_NEAR(length(s.ng), 1, 1e-5f);
            EXPECT_LT(length(s.dpdu - Vec3f{2, 0, 0}), 1e-5f);
            EXPECT_NEAR(dot(s.ng, s.dpdu), 0, 1e-4f);
            EXPECT_NEAR(dot(s.ng, s.dpdv), 0, 1e-4f);
            const Vec3f across = cross(ray.d, s.dpdu); // v grows that way
            if (kind == Curves::Kind::ribbon) {
                EXPECT_LT(length(s.ng - up), 1e-5f);
            } else {
                EXPECT_LT(dot(s.ng, ray.d), 1e-6f);
                EXPECT_GT(dot(across, s.dpdv), -1e-6f);
                const float turned = dot(s.ng, normalize(across));
                const double theta = kind == Curves::Kind::flat ? 0 : (double(s.uv.y) - 0.5) * pi;
                EXPECT_NEAR(turned, std::sin(theta), 1e-3);
            }
            const Vec3f w = draws.direction();
            Ray leaving;
            leaving.o = offset_origin(s.p, s.ng, s.error, w);
            leaving.d = w;
            EXPECT_FALSE(world.accelerator.occluded(leaving)) << i;
        }
        EXPECT_GT(hits, 700);
    }
}

// The normal is that of a tube at the same distance from the axis; u is its azimuth, and v grows over both segments.
TEST(Curves, Tubes) {
    Scene built;
    Curves curves;
    curves.kind = Curves::Kind::tube;
    curves.control_points = {{Point3f{-1, 0, 0}, {-2.0f / 3, 0, 0}, {-1.0f / 3, 0, 0}, {0, 0, 0}},
                             {Point3f{0, 0, 0}, {1.0f / 3, 0, 0}, {2.0f / 3, 0, 0}, {1, 0, 0}}};
    curves.widths = {{0.2f, 0.2f}, {0.2f, 0.2f}};
    add_shape(built, curves);
    const World world(std::move(built));
    Draws draws(29);
    int hits = 0;
    for (int i = 0; i < 1000; ++i) {
        const double turn = double(draws.uniform(0, 6.28f));
        Ray ray;
        ray.d = {0, static_cast<float>(-std::cos(turn)), static_cast<float>(-std::sin(turn))};
        const Vec3f across = cross(ray.d, Vec3f{1, 0, 0});
        const float offset = draws.uniform(-0.095f, 0.095f), x = draws.uniform(-0.95f, 0.95f);
        ray.o = Vec3f{x, 0, 0} + offset * across - 3.0f * ray.d;
        Hit hit;
        if (!world.accelerator.intersect(ray, hit)) continue;
        ++hits;
        const SurfacePoint s = surface_point(world.tables.view(), ray, hit, true);
        EXPECT_NEAR(dot(s.ng, across), offset / 0.1f, 1e-3);
        EXPECT_NEAR(s.ng.x, 0, 1e-5);
        EXPECT_LT(dot(s.ng, ray.d), 0);
        EXPECT_NEAR(s.uv.y, (x + 1) / 2, 1e-4);
        const double azimuth = std::atan2(double(s.ng.z), double(s.ng.y)) / (2 * pi);
        EXPECT_NEAR(s.uv.x, azimuth < 0 ? azimuth + 1 : azimuth, 1e-5);
        EXPECT_LT(length(s.dpdv - Vec3f{2, 0, 0}), 1e-4f);
        const double radians = 2 * pi * double(s.uv.x);
        const Vec3f around(0, static_cast<float>(-std::sin(radians)), static_cast<float>(std::cos(radians)));
        EXPECT_LT(length(s.dpdu - static_cast<float>(0.2 * pi) * around), 1e-3f);
    }
    EXPECT_GT(hits, 900);
}

} // namespace
} // namespace montelux::testing
