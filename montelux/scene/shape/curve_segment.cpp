#include "montelux/scene/shape/curve_segment.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

constexpr int max_depth = 10;

Vec3d mix(Vec3d a, Vec3d b, double t) { return (1 - t) * a + t * b; }

// A quadratic curve raised to degree 3.
CubicBezier elevated(Vec3d a, Vec3d b, Vec3d c) { return {a, mix(a, b, 2.0 / 3), mix(c, b, 2.0 / 3), c}; }

// A span of a uniform B-spline, by the values of its blossom at the span's ends (Ramshaw 1987).
CubicBezier quadratic_span(std::span<const Vec3d> p) {
    return elevated(mix(p[0], p[1], 0.5), p[1], mix(p[1], p[2], 0.5));
}
CubicBezier cubic_span(std::span<const Vec3d> p) {
    const Vec3d a = mix(p[0], p[1], 2.0 / 3), b = mix(p[1], p[2], 1.0 / 3), c = mix(p[1], p[2], 2.0 / 3),
                d = mix(p[2], p[3], 1.0 / 3);
    return {mix(a, b, 0.5), b, c, mix(c, d, 0.5)};
}

double width_of(const CurveSegment& segment, double u) {
    return (1 - u) * segment.width0 + u * segment.width1;
}

// By its blossom (Ramshaw 1987).
CubicBezier part_of(const CubicBezier& c, CurveRange range) {
    const auto [u0, u1] = range;
    if (u0 == 0 && u1 == 1) return c;
    const auto blossom = [&](double r, double s, double t) {
        const Vec3d a = mix(c[0], c[1], r), b = mix(c[1], c[2], r), d = mix(c[2], c[3], r);
        return mix(mix(a, b, s), mix(b, d, s), t);
    };
    return {blossom(u0, u0, u0), blossom(u0, u0, u1), blossom(u0, u1, u1), blossom(u1, u1, u1)};
}

// A segment in the frame of a ray, which is the z axis; z is in units of t.
struct Projected {
    const CurveSegment& segment;
    Vec3d direction; // unit
    double t_min, t_max;
    std::optional<CurveHit> hit{};

    bool may_hit(const CubicBezier& c, double u0, double u1) const {
        const double reach = 0.5 * std::max(width_of(segment, u0), width_of(segment, u1));
        const Vec3d low = min(min(c[0], c[1]), min(c[2], c[3])), high = max(max(c[0], c[1]), max(c[2], c[3]));
        return low.x <= reach && high.x >= -reach && low.y <= reach && high.y >= -reach && low.z < t_max &&
               high.z > t_min;
    }

    void visit(const CubicBezier& c, double u0, double u1, int depth) {
        if (!may_hit(c, u0, u1)) return;
        if (depth == 0) return leaf(c, u0, u1);
        const auto halves = split(c);
        const double middle = 0.5 * (u0 + u1);
        visit(halves[0], u0, middle, depth - 1);
        visit(halves[1], middle, u1, depth - 1);
    }

    // A piece that is almost straight: the axis must pass between the perpendiculars at its ends.
    void leaf(const CubicBezier& c, double u0, double u1) {
        const auto dot2 = [](Vec3d a, Vec3d b) { return a.x * b.x + a.y * b.y; };
        if (dot2(c[1] - c[0], c[0]) > 0 || dot2(c[3] - c[2], c[3]) < 0) return;
        const Vec3d chord = c[3] - c[0];
        const double length2 = dot2(chord, chord);
        if (!(length2 > 0)) return;
        const double w = std::clamp(-dot2(c[0], chord) / length2, 0.0, 1.0), u = u0 + w * (u1 - u0);
        const Vec3d center = point_of(c, w), tangent = derivative_of(c, w);
        double across = width_of(segment, u);
        if (segment.normals) across *= std::abs(dot(normal_of(segment, u), direction));
        const double distance = std::sqrt(dot2(center, center));
        if (!(distance <= 0.5 * across) || !(center.z > t_min && center.z < t_max)) return;
        const double side = tangent.y * center.x - tangent.x * center.y;
        hit = {.t = center.z, .u = u, .v = across > 0 ? 0.5 + std::copysign(distance / across, side) : 0.5};
        t_max = center.z;
    }
};

// The splits after which a curve differs from its chord by at most `error` (Wang's bound: Nakamaru and Ohno
// 2002, equation 3).
int splits(const CubicBezier& c, double error) {
    double bend = 0;
    for (int i = 0; i < 2; ++i) {
        const Vec3d second = c[i] - 2.0 * c[i + 1] + c[i + 2];
        bend = std::max({bend, std::abs(second.x), std::abs(second.y)});
    }
    const double ratio = std::sqrt(2.0) * 6 * bend / (8 * error);
    if (!(ratio > 1)) return 0;
    return std::min(max_depth, static_cast<int>(std::ceil(0.5 * std::log2(ratio))));
}

} // namespace

// The control points hold a Bezier curve in their convex hull.
Bounds3 bounds_of(const CurveSegment& segment, CurveRange range) {
    const double reach = 0.5 * std::max(width_of(segment, range.u0), width_of(segment, range.u1));
    Bounds3 bounds;
    for (const Vec3d p : part_of(segment.curve, range)) {
        bounds.add(p - Vec3d{reach, reach, reach});
        bounds.add(p + Vec3d{reach, reach, reach});
    }
    return bounds;
}

std::vector<CubicBezier> bezier_segments(std::span<const Point3f> points, CurveBasis basis, int degree) {
    if (degree != 2 && degree != 3) throw Error("a curve has degree 2 or 3, not " + std::to_string(degree));
    const auto step = basis == CurveBasis::bezier ? static_cast<std::size_t>(degree) : 1;
    const auto count = static_cast<std::size_t>(degree) + 1;
    if (points.size() < count || (points.size() - count) % step != 0)
        throw Error(std::to_string(points.size()) + " control points were given; expected " +
                    std::to_string(count) + (step == 1 ? " or more" : " + n * " + std::to_string(step)));
    std::vector<CubicBezier> segments;
    for (std::size_t first = 0; first + count <= points.size(); first += step) {
        Vec3d p[4];
        for (std::size_t i = 0; i < count; ++i) p[i] = Vec3d(points[first + i]);
        if (basis == CurveBasis::bezier)
            segments.push_back(degree == 2 ? elevated(p[0], p[1], p[2])
                                           : CubicBezier{p[0], p[1], p[2], p[3]});
        else
            segments.push_back(degree == 2 ? quadratic_span(p) : cubic_span(p));
    }
    return segments;
}

Vec3d point_of(const CubicBezier& c, double u) {
    const double s = 1 - u;
    return s * s * s * c[0] + 3 * s * s * u * c[1] + 3 * s * u * u * c[2] + u * u * u * c[3];
}

Vec3d derivative_of(const CubicBezier& c, double u) {
    const double s = 1 - u;
    return 3 * s * s * (c[1] - c[0]) + 6 * s * u * (c[2] - c[1]) + 3 * u * u * (c[3] - c[2]);
}

std::array<CubicBezier, 2> split(const CubicBezier& c) {
    const Vec3d a = mix(c[0], c[1], 0.5), b = mix(c[1], c[2], 0.5), d = mix(c[2], c[3], 0.5);
    const Vec3d ab = mix(a, b, 0.5), bd = mix(b, d, 0.5), middle = mix(ab, bd, 0.5);
    return {CubicBezier{c[0], a, ab, middle}, CubicBezier{middle, bd, d, c[3]}};
}

Vec3d normal_of(const CurveSegment& segment, double u) {
    const auto& [a, b] = *segment.normals;
    const double angle = std::atan2(length(cross(a, b)), dot(a, b)), sine = std::sin(angle);
    if (!(sine > 1e-9)) return a;
    return (std::sin((1 - u) * angle) * a + std::sin(u * angle) * b) / sine;
}

std::optional<CurveHit> intersect(const CurveSegment& segment, Vec3d o, Vec3d d, double t_min, double t_max,
                                  CurveRange range) {
    const double speed = length(d);
    if (!(speed > 0)) return std::nullopt;
    const Vec3d z = d / speed;
    // An axis perpendicular to the chord makes the boxes of the pieces narrow.
    Vec3d x = cross(z, segment.curve[3] - segment.curve[0]);
    if (!(dot(x, x) > 0)) x = cross(z, std::abs(z.x) < 0.5 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0});
    x = normalize(x);
    const Vec3d y = cross(z, x);
    CubicBezier c;
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3d p = segment.curve[i] - o;
        c[i] = {dot(p, x), dot(p, y), dot(p, z) / speed};
    }
    Projected projected{.segment = segment, .direction = z, .t_min = t_min, .t_max = t_max};
    c = part_of(c, range);
    const double width = std::max(width_of(segment, range.u0), width_of(segment, range.u1));
    projected.visit(c, range.u0, range.u1, splits(c, 0.05 * width));
    return projected.hit;
}

} // namespace montelux
