// Areas of quadrics and points distributed over them. Chi-squared tests at 1e-8 each, sums at 5.5 standard
// errors (4e-8): below 2e-7 for the file.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/scene/shape/quadric.h"

namespace montelux {
namespace {

// Two points that are close to one another differ by what the derivatives say of their coordinates.
TEST(Quadrics, DerivativesAreThoseOfTheCoordinates) {
    const Transform place = Transform::translate({1, 2, 3}) * Transform::rotate(40, {1, -2, 0.5}) *
                            Transform::scale({2, -0.7, 1.3});
    const Quadric quadrics[] = {
        Sphere{.radius = 2, .z_min = -2, .z_max = 2, .world_from_object = place},
        Sphere{.radius = 2, .z_min = -1, .z_max = 1.5f, .phi_max = 0.8f, .world_from_object = place},
        Disk{.height = 0.5f, .radius = 2, .world_from_object = place},
        Disk{.radius = 2, .inner_radius = 0.5f, .phi_max = 3, .world_from_object = place},
        Disk{.radius = 2, .inner_radius = 0.5f, .phi_max = 3, .polar = true, .world_from_object = place},
        Cylinder{.radius = 2, .world_from_object = place},
        Cylinder{.radius = 0.5f, .z_min = 1, .z_max = 1.5f, .phi_max = 0.8f, .world_from_object = place}};
    TestUniforms u(3);
    for (const Quadric& quadric : quadrics)
        for (int i = 0; i < 200; ++i) {
            const Vec2f at{0.1f + 0.8f * u.next_float(), 0.1f + 0.8f * u.next_float()};
            auto point = [&](float dx, float dy) {
                const Vec3d p = sample_area(quadric, {at.x + dx, at.y + dy}).point.p;
                // Through the point and along its normal: floats of the ray are far coarser than the step.
                return point_at(quadric, {Vec3f(p), {0, 0, 1}}, 0, true);
            };
            const QuadricPoint p = point(0, 0);
            for (const auto& [dx, dy] : {Vec2f{1e-2f, 0}, Vec2f{0, 1e-2f}}) {
                const QuadricPoint a = point(-dx, -dy), b = point(dx, dy);
                const Vec2d uv = Vec2d(b.uv) - Vec2d(a.uv);
                const Vec3d step = b.p - a.p;
                EXPECT_LT(length(step - (uv.x * p.dpdu + uv.y * p.dpdv)), 0.01 * length(step) + 1e-5);
            }
        }
}

TEST(Quadrics, AreasInClosedForm) {
    Transform twice = Transform::rotate(30, {1, 2, 3}) * Transform::scale({2, -2, 2});
    EXPECT_NEAR(world_area(Sphere{.radius = 1.5f, .z_min = -1.5f, .z_max = 1.5f, .world_from_object = {}}),
                4 * pi * 2.25, 1e-4);
    EXPECT_NEAR(world_area(Sphere{.z_min = -0.25f, .z_max = 0.5f, .phi_max = 2, .world_from_object = twice}),
                4 * 2 * 0.75, 1e-4);
    EXPECT_NEAR(world_area(Disk{.radius = 2, .inner_radius = 1, .phi_max = 3, .world_from_object = twice}),
                4 * 0.5 * 3 * 3, 1e-4);
    EXPECT_NEAR(world_area(Disk{.radius = 2, .world_from_object = Transform::scale({3, 0.5, 9})}),
                pi * 4 * 1.5, 1e-3);
    EXPECT_NEAR(world_area(Cylinder{
                    .radius = 1.5f, .z_min = 1, .z_max = 3, .phi_max = 2, .world_from_object = twice}),
                4 * 2 * 1.5 * 2, 1e-4);
    // Stretched along its axis, and to an ellipse of half axes 1 and 1/2, whose circumference is
    // 4 E(m = 3/4).
    EXPECT_NEAR(world_area(Cylinder{.world_from_object = Transform::scale({1, 1, 3})}), 2 * pi * 6, 1e-4);
    EXPECT_NEAR(world_area(Cylinder{.world_from_object = Transform::scale({1, 0.5, 3})}), 4.8442241102738 * 6,
                1e-3);
    // Oblate spheroid with axes 1, 1, 1/2.
    double e = std::sqrt(0.75);
    EXPECT_NEAR(world_area(Sphere{.world_from_object = Transform::scale({1, 1, 0.5})}),
                2 * pi * (1 + (1 - e * e) / e * std::atanh(e)), 2e-3);
}

TEST(Quadrics, AreaSamplesLieOnTheSurfaceWithTheirDensity) {
    Transform odd =
        Transform::translate({1, 2, 3}) * Transform::rotate(50, {1, 2, 0}) * Transform::scale({2, 0.5, 1});
    const Quadric cases[] = {
        Sphere{.radius = 2, .z_min = -2, .z_max = 2, .world_from_object = {}},
        Sphere{.z_min = -0.3f, .z_max = 0.8f, .phi_max = 4, .world_from_object = odd},
        Disk{.height = 0.5f, .radius = 2, .inner_radius = 0.5f, .phi_max = 5, .world_from_object = odd},
        Cylinder{.radius = 2, .z_min = -1, .z_max = 3, .phi_max = 5, .world_from_object = odd}};
    for (const Quadric& q : cases) {
        TestUniforms uniforms(4);
        RunningMoments inverse_density;
        std::vector<double> octants(4), expected(4, 5000);
        Transform inverse = std::visit([](const auto& s) { return s.world_from_object.inverse(); }, q);
        for (int i = 0; i < 20000; ++i) {
            QuadricAreaSample s = sample_area(q, uniforms.next_2f());
            ASSERT_NEAR(area_pdf(q, s.point.p) / s.pdf, 1, 1e-5);
            ASSERT_NEAR(length(s.point.n), 1, 1e-6);
            inverse_density.add(1 / s.pdf);
            Vec3d p = inverse.point(s.point.p);
            if (const auto* sphere = std::get_if<Sphere>(&q)) {
                ASSERT_NEAR(length(p), sphere->radius, 1e-5);
                ASSERT_GE(p.z, sphere->z_min - 1e-5);
                ASSERT_LE(p.z, sphere->z_max + 1e-5);
                // Archimedes: uniform in z.
                double t = (p.z - sphere->z_min) / (double(sphere->z_max) - double(sphere->z_min));
                octants[static_cast<std::size_t>(std::clamp(static_cast<int>(4 * t), 0, 3))] += 1;
            } else if (const auto* c = std::get_if<Cylinder>(&q)) {
                ASSERT_NEAR(std::hypot(p.x, p.y), c->radius, 1e-5);
                const double t = (p.z - c->z_min) / (double(c->z_max) - double(c->z_min));
                ASSERT_GE(t, -1e-5);
                ASSERT_LE(t, 1 + 1e-5);
                octants[static_cast<std::size_t>(std::clamp(static_cast<int>(4 * t), 0, 3))] += 1;
            } else {
                const auto& disk = std::get<Disk>(q);
                double r2 = p.x * p.x + p.y * p.y, lo = disk.inner_radius * disk.inner_radius;
                ASSERT_NEAR(p.z, disk.height, 1e-6);
                double t = (r2 - lo) / (disk.radius * disk.radius - lo);
                octants[static_cast<std::size_t>(std::clamp(static_cast<int>(4 * t), 0, 3))] += 1;
            }
        }
        EXPECT_NEAR(inverse_density.mean(), world_area(q), 5.5 * inverse_density.standard_error() + 1e-3);
        TestResult r = chi_squared_test(octants, expected);
        EXPECT_TRUE(r.passes(1e-8)) << r.description;
    }
}

} // namespace
} // namespace montelux
