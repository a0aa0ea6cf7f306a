// Bilinear patches: rays, areas, tangents, and positions of a density. Draws are fixed; one chi-squared test at 1e-8.
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/scene/shape/bilinear_patch.h"
#include "montelux/scene/shape/surface_point.h"

namespace montelux {
namespace {

const BilinearPatch twisted = {{-1, -1, 0.5}, {1, -0.8, -0.4}, {-0.7, 1, -0.6}, {1.2, 0.9, 0.8}};

BilinearPatch random_patch(TestUniforms& uniforms, double size) {
    const auto point = [&] {
        const double x = uniforms.next_float(), y = uniforms.next_float(), z = uniforms.next_float();
        return size * Vec3d{2 * x - 1, 2 * y - 1, 2 * z - 1};
    };
    const Vec3d a = point(), b = point(), c = point(), d = point();
    return {a, b, c, d};
}

TEST(BilinearPatch, DerivativesAndNormal) {
    const double h = 1e-6, u = 0.3, v = 0.8;
    const Vec3d du = (point_of(twisted, u + h, v) - point_of(twisted, u - h, v)) / (2 * h);
    const Vec3d dv = (point_of(twisted, u, v + h) - point_of(twisted, u, v - h)) / (2 * h);
    EXPECT_LT(length(du - dpdu_of(twisted, v)), 1e-8);
    EXPECT_LT(length(dv - dpdv_of(twisted, u)), 1e-8);
    const Vec3d between = bilinear(normal_of(twisted, 0, 0), normal_of(twisted, 1, 0),
                                   normal_of(twisted, 0, 1), normal_of(twisted, 1, 1), u, v);
    EXPECT_LT(length(between - cross(du, dv)), 1e-8);
}

// Along a line of constant u or v, positions and texture coordinates are linear: their differences are exact.
TEST(BilinearPatch, TangentsFollowTheTextureCoordinates) {
    Scene scene;
    scene.bilinear_meshes.push_back(
        {.positions = {Vec3f(twisted.p00), Vec3f(twisted.p10), Vec3f(twisted.p01), Vec3f(twisted.p11)},
         .normals = {},
         .uvs = {{0, 0.1f}, {1, 0}, {-0.2f, 0.8f}, {2, 1.5f}},
         .indices = {0, 1, 2, 3}});
    scene.shapes = {{.geometry = BilinearMeshIndex{0}}};
    scene.world_shapes = {0};
    const SceneView view(scene);
    const auto at = [&](float u, float v) {
        return surface_point(view, {}, {.b1 = u, .b2 = v, .shape = 0, .instance = no_index}, true);
    };
    for (const float u : {0.25f, 0.75f})
        for (const float v : {0.25f, 0.5f}) {
            const SurfacePoint s = at(u, v);
            for (const Vec2f step : {Vec2f{0.25f, 0}, Vec2f{0, 0.25f}}) {
                const SurfacePoint a = at(u - step.x, v - step.y), b = at(u + step.x, v + step.y);
                const Vec2f d = b.uv - a.uv;
                EXPECT_LT(length(d.x * s.dpdu + d.y * s.dpdv - (b.p - a.p)), 1e-5f) << u << ' ' << v;
            }
        }
}

TEST(BilinearPatch, Area) {
    const BilinearPatch trapezoid = {{0, 0, 1}, {3, 0, 1}, {0, 2, 1}, {1, 2, 1}};
    EXPECT_NEAR(area_of(trapezoid), 4, 1e-12);
    // z = x y on the unit square: the integral of sqrt(1 + x^2 + y^2).
    const BilinearPatch saddle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}};
    const double root3 = std::sqrt(3.0);
    const double area = root3 / 3 + 2.0 / 3 * std::log((1 + root3) * (1 + root3) / 2) - pi / 18;
    EXPECT_NEAR(area_of(saddle), area, 1e-9);
}

// Whatever the patch, its scale and its distance: rays to a point of it meet it there or before.
TEST(BilinearPatch, RaysMeetTheirPoint) {
    TestUniforms uniforms(31);
    int before = 0;
    for (int i = 0; i < 20000; ++i) {
        const double size = std::pow(10.0, 8 * double(uniforms.next_float()) - 4);
        const BilinearPatch patch = random_patch(uniforms, size);
        const double u = uniforms.next_float(), v = uniforms.next_float();
        const Vec3d p = point_of(patch, u, v), o = random_patch(uniforms, 3 * size).p00;
        const double stretch = 0.1 + double(uniforms.next_float());
        const auto hit = intersect(patch, o, (p - o) * stretch, 0, 1e30);
        ASSERT_TRUE(hit) << i;
        const Vec3d met = o + (p - o) * stretch * hit->t;
        EXPECT_LT(length(met - point_of(patch, hit->u, hit->v)), 1e-7 * size) << i;
        EXPECT_LT(hit->t * stretch, 1 + 1e-7);
        before += hit->t * stretch < 1 - 1e-7;
        const auto next = intersect(patch, o, (p - o) * stretch, hit->t * (1 + 1e-9), 1e30);
        if (hit->t * stretch < 1 - 1e-7) {
            ASSERT_TRUE(next) << i;
            EXPECT_NEAR(next->t * stretch, 1, 1e-6);
        }
        EXPECT_FALSE(intersect(patch, o, (p - o) * stretch, 0, hit->t * 0.999999));
        EXPECT_FALSE(intersect(patch, o, -(p - o), hit->t * 1e6, 1e30));
    }
    EXPECT_GT(before, 500);
}

// Rays through the common edge of two patches hit one of them.
TEST(BilinearPatch, NoGapAtSharedEdges) {
    TestUniforms uniforms(32);
    for (int i = 0; i < 20000; ++i) {
        const BilinearPatch left = random_patch(uniforms, 1);
        BilinearPatch right = random_patch(uniforms, 1);
        right.p00 = left.p10;
        right.p01 = left.p11;
        const double x = uniforms.next_float();
        const Vec3d p = (1 - x) * left.p10 + x * left.p11, o = random_patch(uniforms, 100).p00;
        EXPECT_TRUE(intersect(left, o, p - o, 0, 2) || intersect(right, o, p - o, 0, 2)) << i;
    }
}

TEST(BilinearPatch, DegenerateOnesAreNoTrouble) {
    const Vec3d p{1, 2, 3};
    EXPECT_FALSE(intersect(BilinearPatch{p, p, p, p}, {0, 0, 0}, p, 0, 10));
    EXPECT_EQ(area_of({p, p, p, p}), 0);
    EXPECT_EQ(sample_area({p, p, p, p}, {0.3, 0.7}).pdf, 0);
    // Edge on: no hit, or one on the plane.
    EXPECT_FALSE(intersect({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {-1, 0.5, 0}, {1, 0, 0}, 0, 10));
    // A triangle: two corners coincide.
    const auto hit =
        intersect({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}}, {0.2, 0.3, 1}, {0, 0, -1}, 0, 10);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->v, 0.3, 1e-12);
}

TEST(BilinearPatch, PositionsFollowTheirDensity) {
    const auto sample = [](Vec2d random) {
        const PatchSample s = sample_area(twisted, random);
        EXPECT_NEAR(s.pdf / area_pdf(twisted, s.u, s.v), 1, 1e-12);
        return Vec2d{s.u, s.v};
    };
    const auto pdf = [](Vec2d p) {
        return area_pdf(twisted, p.x, p.y) * length(normal_of(twisted, p.x, p.y));
    };
    const TestResult r = rectangle_chi_squared_test(sample, pdf, {0, 0}, {1, 1});
    EXPECT_TRUE(r.passes(1e-8)) << r.description;
    // Nearly constant per area, and constant on parallelograms.
    TestUniforms uniforms(33);
    for (int i = 0; i < 100; ++i) {
        const double u = uniforms.next_float(), v = uniforms.next_float();
        EXPECT_NEAR(area_pdf(twisted, u, v) * area_of(twisted), 1, 0.3);
        EXPECT_NEAR(area_pdf({{0, 0, 0}, {3, 0, 0}, {1, 2, 0}, {4, 2, 0}}, u, v), 1.0 / 6, 1e-12);
    }
}

} // namespace
} // namespace montelux
