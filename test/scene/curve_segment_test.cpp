// Curves: bases against their definitions, hits against rectangles and a search along the curve. Without
// randomness except fixed seeds.
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/scene/shape/curve_segment.h"
#include "montelux/scene/shape/curves.h"

namespace montelux {
namespace {

std::vector<Point3f> some_points(std::size_t n) {
    TestUniforms u(5);
    std::vector<Point3f> p(n);
    for (Point3f& q : p) q = {u.next_float(), u.next_float(), u.next_float()};
    return p;
}

// The basis functions of uniform B-splines (Farin, "Curves and Surfaces for CAGD", section 8.1).
TEST(CurveSegments, BSplinesHaveTheirBasisFunctions) {
    const auto p = some_points(7);
    for (const int degree : {2, 3}) {
        const auto segments = bezier_segments(p, CurveBasis::bspline, degree);
        ASSERT_EQ(segments.size(), 7 - static_cast<std::size_t>(degree));
        for (std::size_t i = 0; i < segments.size(); ++i)
            for (const double u : {0.0, 0.3, 1.0}) {
                const double s = 1 - u;
                const std::vector<double> b =
                    degree == 2 ? std::vector<double>{s * s / 2, (1 + 2 * u - 2 * u * u) / 2, u * u / 2}
                                : std::vector<double>{s * s * s / 6, (3 * u * u * u - 6 * u * u + 4) / 6,
                                                      (3 * s * s * s - 6 * s * s + 4) / 6, u * u * u / 6};
                Vec3d expected;
                for (std::size_t k = 0; k < b.size(); ++k) expected = expected + b[k] * Vec3d(p[i + k]);
                EXPECT_LT(length(point_of(segments[i], u) - expected), 1e-12);
            }
    }
}

TEST(CurveSegments, QuadraticCurvesKeepTheirShape) {
    const auto p = some_points(5);
    const auto segments = bezier_segments(p, CurveBasis::bezier, 2);
    ASSERT_EQ(segments.size(), 2);
    for (const double u : {0.0, 0.2, 0.7, 1.0}) {
        const double s = 1 - u;
        const Vec3d expected = s * s * Vec3d(p[2]) + 2 * s * u * Vec3d(p[3]) + u * u * Vec3d(p[4]);
        EXPECT_LT(length(point_of(segments[1], u) - expected), 1e-12);
    }
    EXPECT_EQ(bezier_segments(some_points(7), CurveBasis::bezier, 3).size(), 2);
    EXPECT_THROW(bezier_segments(some_points(6), CurveBasis::bezier, 3), Error);
    EXPECT_THROW(bezier_segments(some_points(3), CurveBasis::bspline, 3), Error);
    EXPECT_THROW(bezier_segments(p, CurveBasis::bezier, 4), Error);
}

TEST(CurveSegments, HalvesJoin) {
    const CubicBezier c = bezier_segments(some_points(4), CurveBasis::bezier, 3)[0];
    const auto halves = split(c);
    for (const double u : {0.0, 0.4, 1.0}) {
        EXPECT_LT(length(point_of(halves[0], u) - point_of(c, 0.5 * u)), 1e-12);
        EXPECT_LT(length(point_of(halves[1], u) - point_of(c, 0.5 + 0.5 * u)), 1e-12);
        EXPECT_LT(length(derivative_of(halves[1], u) - 0.5 * derivative_of(c, 0.5 + 0.5 * u)), 1e-12);
    }
}

// A straight curve that faces the rays is a trapezium.
TEST(CurveSegments, AStraightCurveIsATrapezium) {
    const CurveSegment s{{Vec3d{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, 0.4, 0.1, {}};
    int hits = 0;
    for (double x = -0.55; x < 3.5; x += 0.1)
        for (double y = -0.31; y < 0.31; y += 0.02) {
            const auto hit = intersect(s, {x, y, -4}, {0, 0, 2}, 0, 1e30);
            const double width = 0.4 - 0.1 * x;
            ASSERT_EQ(hit.has_value(), x > 0 && x < 3 && std::abs(y) < 0.5 * width) << x << ' ' << y;
            if (!hit) continue;
            ++hits;
            EXPECT_NEAR(hit->t, 2, 1e-12);
            EXPECT_NEAR(hit->u, x / 3, 1e-12);
            EXPECT_NEAR(hit->v, 0.5 + y / width, 1e-12); // z cross x = y
        }
    EXPECT_GT(hits, 300);
    EXPECT_FALSE(intersect(s, {1.5, 0, -4}, {0, 0, 2}, 2.1, 1e30));
    EXPECT_FALSE(intersect(s, {1.5, 0, -4}, {0, 0, 2}, 0, 1.9));
}

// Seen under 60 degrees a ribbon is half as wide; edge on it vanishes.
TEST(CurveSegments, RibbonsAreSeenByTheirNormals) {
    CurveSegment s{{Vec3d{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, 1, 1, {}};
    const auto width_seen = [&](double x) {
        int hits = 0;
        for (int i = 0; i < 2000; ++i)
            hits += intersect(s, {x, -0.7 + 1.4 * (i + 0.5) / 2000, -4}, {0, 0, 1}, 0, 1e30).has_value();
        return 1.4 * hits / 2000;
    };
    const auto tilted = [](double angle) { return Vec3d{0, std::sin(angle), std::cos(angle)}; };
    EXPECT_NEAR(width_seen(1), 1, 2e-3);
    s.normals = {{tilted(std::acos(0.5)), tilted(std::acos(0.5))}};
    EXPECT_NEAR(width_seen(1), 0.5, 2e-3);
    s.normals = {{tilted(0), tilted(1.2)}};
    for (const double u : {0.1, 0.5, 0.9}) EXPECT_NEAR(width_seen(3 * u), std::cos(1.2 * u), 2e-3);
}

// Bent curves against the distance of the ray from the curve, by search.
TEST(CurveSegments, BentCurvesAreHitWhereTheyAre) {
    TestUniforms uniforms(8);
    int hits = 0, misses = 0;
    for (int i = 0; i < 2000; ++i) {
        CurveSegment s;
        for (Vec3d& p : s.curve) p = {uniforms.next_float(), uniforms.next_float(), uniforms.next_float()};
        s.width0 = s.width1 = 0.05;
        const double aim = uniforms.next_float();
        const Vec3d at = point_of(s.curve, aim);
        const Vec3d o{2 * uniforms.next_float(), 2 * uniforms.next_float(), -2};
        const Vec3d to = at + 0.1 * Vec3d{uniforms.next_float() - 0.5f, uniforms.next_float() - 0.5f, 0};
        const Vec3d d = to - o;
        double nearest = 1e30, end = 1;
        for (int k = 0; k <= 2000; ++k) {
            const Vec3d p = point_of(s.curve, k / 2000.0) - o;
            const double distance = length(cross(p, normalize(d)));
            if (distance < nearest) {
                nearest = distance;
                end = std::min(k, 2000 - k) / 2000.0;
            }
        }
        if (end < 0.05 || std::abs(nearest - 0.025) < 0.005) continue;
        const auto hit = intersect(s, o, d, 0, 1e30);
        ASSERT_EQ(hit.has_value(), nearest < 0.025) << i << ' ' << nearest;
        (hit ? hits : misses) += 1;
        if (!hit) continue;
        EXPECT_LT(length(o + hit->t * d - point_of(s.curve, hit->u)), 0.03);
    }
    EXPECT_GT(hits, 300);
    EXPECT_GT(misses, 300);
}

// Under non-uniform scaling the normals of a ribbon stay perpendicular to it.
TEST(Strands, NormalsOfRibbonsStayPerpendicular) {
    const Point3f points[] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
    const Normal3f normals[] = {{0, 1, 1}, {0, -0.5f, 2}};
    const Transform t = Transform::rotate(50, {1, 2, 3}) * Transform::scale({2, 1, 3});
    Curves curves;
    curves.kind = Curves::Kind::ribbon;
    append(curves, {.points = points, .normals = normals}, t);
    ASSERT_EQ(curves.normals.size(), 1);
    for (std::size_t k = 0; k < 2; ++k) {
        const Vec3d along{1, 0, 0}, n(curves.normals[0][k]);
        EXPECT_NEAR(length(n), 1, 1e-6);
        EXPECT_NEAR(dot(n, normalize(t.vector(along))), 0, 1e-6);
        EXPECT_NEAR(dot(n, normalize(t.vector(cross(along, Vec3d(normals[k]))))), 0, 1e-6);
        EXPECT_GT(dot(n, t.vector(Vec3d(normals[k]))), 0);
    }
}

} // namespace
} // namespace montelux
