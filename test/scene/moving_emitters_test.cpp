// Shapes that emit and move: at any time they are the still one that stands there, hits and samples have one density,
// and the bounds of light trees hold at all times.
#include "test/sanitized.h"
#include "test/scene/moving_emitter_testing.h"
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <optional>
#include <vector>

#include "montelux/scene/light/motion_bounds.h"
#include "montelux/scene/scene_digest.h"

namespace montelux::testing::moving {
namespace {

LightHit hit_on(const SurfacePoint& s, Vec3f wi) {
    return {.wi = wi, .part = s.primitive, .p = s.p, .n = s.ng, .b = s.b};
}

// For the same random numbers: direction, radiance, density, and where the shadow ray ends.
TEST(MovingEmitters, AreSampledAsTheStillOneThatIsThere) {
    for (const Emitter& e : emitters()) {
        const World moving(e.moving());
        for (const float time : times) {
            const World still(e.still(time));
            Draws draws(3);
            int found = 0, differ = 0;
            for (int i = 0; i < 2000; ++i) {
                const ReferencePoint from{.p = draws.in_cube(6)};
                const Vec2f u = draws.uniform_2d();
                const Index parts = part_count({moving.tables.view(), 0});
                ASSERT_EQ(parts, part_count({still.tables.view(), 0}));
                const auto part = static_cast<Index>(i) % parts;
                const auto a = sample_li({moving.tables.view(), 0, time}, part, from, u, lambda);
                const auto b = sample_li({still.tables.view(), 0}, part, from, u, lambda);
                if (a.has_value() != b.has_value()) {
                    ++differ; // at the horizon, and where a cone is almost a hemisphere
                    continue;
                }
                found += a.has_value();
                if (!a) continue;
                const Vec3f p = a->shadow.o + a->shadow.d, q = b->shadow.o + b->shadow.d;
                const bool same = length(p - q) < 2e-3f && near(a->pdf, b->pdf, 1e-2f) &&
                                  near(a->radiance[0], b->radiance[0], 1e-3f);
                differ += !same; // close to the light or its plane
            }
            EXPECT_LT(differ, 20) << e.name << " at " << time;
            EXPECT_GT(found, 300) << e.name << " at " << time;
        }
    }
}

// A ray along a sample meets the light at that time where the sample is, with its density and radiance.
TEST(MovingEmitters, SamplesAgreeWithHits) {
    for (const Emitter& e : emitters()) {
        const World world(e.moving());
        const SceneView& view = world.tables.view();
        Draws draws(5);
        int met = 0, differ = 0;
        for (int i = 0; i < 10000; ++i) {
            const float time = draws.uniform();
            const ReferencePoint from{.p = draws.in_cube(6)};
            const Index part = static_cast<Index>(i) % part_count({view, 0});
            const auto s = sample_li({view, 0, time}, part, from, draws.uniform_2d(), lambda);
            if (!s) continue;
            const Ray ray{from.p, s->wi, std::numeric_limits<float>::infinity(), time};
            Hit hit;
            if (!world.accelerator.intersect(ray, hit) || hit.primitive != part) continue;
            ASSERT_EQ(view.light_at(hit), 0u);
            const SurfacePoint point = surface_point(view, ray, hit, false);
            if (length(point.p - (s->shadow.o + s->shadow.d)) > 1e-3f) continue; // another sheet of it
            ++met;
            const LightHit at = hit_on(point, s->wi);
            const bool same =
                near(pdf_li({view, 0, time}, from, at), s->pdf, 5e-3f) &&
                near(incident_radiance({view, 0, time}, from, at, lambda)[0], s->radiance[0], 1e-3f);
            differ += !same; // grazing
        }
        EXPECT_GT(met, 1000) << e.name;
        EXPECT_LT(differ, 1 + met / 100) << e.name;
    }
}

// Emission leaves the bounds that light trees are built from at no time, and its density is that of pdf_le.
TEST(MovingEmitters, StayWithinTheirBounds) {
    for (const Emitter& e : emitters()) {
        const World world(e.moving());
        const SceneView& view = world.tables.view();
        std::vector<std::optional<LightBounds>> at_any_time;
        for (Index part = 0; part < part_count({view, 0}); ++part)
            at_any_time.push_back(motion_bounds({view, 0}, part));
        Draws draws(7);
        for (int i = 0; i < (under_sanitizers ? 500 : 4000); ++i) {
            const Index part = static_cast<Index>(i) % part_count({view, 0});
            const LightContext context{view, 0, draws.uniform()};
            const auto s = sample_le(context, part, draws.uniform_2d(), draws.uniform_2d(), lambda);
            if (!s) continue;
            EXPECT_EQ(s->ray.time, context.time);
            for (const auto& b : {at_any_time[part], light_bounds(context, part)}) {
                ASSERT_TRUE(b.has_value());
                for (int k = 0; k < 3; ++k) {
                    ASSERT_GT(double(s->ray.o[k]), b->box.lower[k] - 1e-4) << e.name;
                    ASSERT_LT(double(s->ray.o[k]), b->box.upper[k] + 1e-4) << e.name;
                }
                float cosine = dot(s->n, b->axis);
                if (b->two_sided) cosine = std::abs(cosine);
                ASSERT_GT(cosine, b->cos_theta_o - 1e-5f) << e.name;
            }
            LightHit at{.part = part, .p = s->ray.o, .n = s->n};
            if (std::holds_alternative<BilinearMesh>(e.geometry)) continue; // its density wants u and v
            const EmissionPdf pdf = pdf_le(context, at, s->ray.d);
            ASSERT_TRUE(near(pdf.position, s->pdf_position, 2e-3f)) << e.name;
        }
    }
}

// A flat one that turns by less than a right angle has a cone, one that only travels its single normal.
TEST(MovingEmitters, BoundsAreTight) {
    const auto cone = [](const Transform& end) {
        const World world(Emitter{"disk", Quadric(Disk{.world_from_object = {}}), {}, end}.moving());
        return *motion_bounds({world.tables.view(), 0}, 0);
    };
    const LightBounds travels = cone(Transform::translate({9, 0, 0}));
    EXPECT_EQ(travels.cos_theta_o, 1);
    EXPECT_EQ(travels.axis.z, 1);
    EXPECT_NEAR(travels.box.upper.x, 10, 1e-6);
    EXPECT_NEAR(travels.box.lower.x, -1, 1e-6);
    const LightBounds turns = cone(Transform::rotate(60, {1, 0, 0}));
    EXPECT_NEAR(turns.cos_theta_o, std::cos(30 * pi / 180), 1e-3);
    EXPECT_NEAR(dot(turns.axis, Vec3f(Transform::rotate(30, {1, 0, 0}).vector(Vec3d{0, 0, 1}))), 1, 1e-5);
    EXPECT_NEAR(cone(Transform::rotate(179, {1, 0, 0})).cos_theta_o, std::cos(89.5 * pi / 180), 1e-3);
}

// The vertex normals at the time of the ray decide which side emits.
TEST(MovingEmitters, NormalsThatTurnOverTurnTheLight) {
    TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {}, {0, 1, 2}};
    mesh.normals.assign(3, {0, 0, -1});
    mesh.end_positions = mesh.positions;
    mesh.end_normals.assign(3, {0, 0, 1});
    const World world(Emitter{"mesh", mesh}.moving());
    for (const float time : {0.0f, 0.4f, 0.6f, 1.0f}) {
        const LightContext context{world.tables.view(), 0, time};
        const float side = time < 0.5f ? -1 : 1;
        const auto leaving = sample_le(context, 0, {0.3f, 0.6f}, {0.2f, 0.7f}, lambda);
        ASSERT_TRUE(leaving.has_value()) << time;
        EXPECT_EQ(leaving->n.z, side) << time;
        EXPECT_GT(leaving->ray.d.z * side, 0) << time;
        const auto seen_from = [&](float z) {
            return sample_li(context, 0, {.p = {0.2f, 0.3f, z}}, {0.3f, 0.6f}, lambda).has_value();
        };
        EXPECT_TRUE(seen_from(side)) << time;
        EXPECT_FALSE(seen_from(-side)) << time;
    }
}

// Powers are means over the motion: a triangle that has no area at the start is found.
TEST(MovingEmitters, WithoutAreaAtTheStartHavePower) {
    TriangleMesh mesh = emission::two_triangles();
    mesh.end_positions = mesh.positions;
    for (Point3f& p : mesh.positions) p = {};
    const World world(Emitter{"mesh", mesh}.moving());
    double powers[2] = {};
    light_powers({world.tables.view(), 0}, powers);
    // Its area grows with the square of the time.
    EXPECT_NEAR(powers[0], 2 * pi * emission::area_of(0, 1, 2) / 3, 1e-5);
    EXPECT_NEAR(powers[1], 2 * pi * emission::area_of(2, 1, 3) / 3, 1e-5);
    const World grows(Emitter{"disk", Quadric(Disk{.world_from_object = {}}), Transform::scale({1, 1, 1}),
                              Transform::scale({3, 3, 3})}
                          .moving());
    light_powers({grows.tables.view(), 0}, std::span(powers).first(1));
    EXPECT_NEAR(powers[0], 2 * pi * pi * (1 + 2 + 4.0 / 3), 1e-3);
}

// Two uses of an object, or none: which would shine? And objects of files are dark.
TEST(MovingEmitters, OfObjectsShineIfTheObjectHasOneInstance) {
    Scene scene =
        Emitter{"disk", Quadric(Disk{.world_from_object = {}}), {}, Transform::translate({1, 0, 0})}.moving();
    const auto parts = [&] {
        const SceneTables tables(scene);
        Hit hit{.shape = 0, .instance = 0};
        EXPECT_EQ(tables.view().light_at(hit), part_count({tables.view(), 0}) > 0 ? 0 : no_index);
        return part_count({tables.view(), 0});
    };
    EXPECT_EQ(parts(), 1u);
    const SceneDigest before = digest_of(scene);
    scene.objects[0].shines = false;
    EXPECT_EQ(parts(), 0u);
    EXPECT_NE(digest_of(scene).geometry, before.geometry);
    scene.objects[0].shines = true;
    scene.instances.push_back(scene.instances[0]);
    EXPECT_EQ(parts(), 0u);
    scene.instances.clear();
    EXPECT_EQ(parts(), 0u);
}

} // namespace
} // namespace montelux::testing::moving
