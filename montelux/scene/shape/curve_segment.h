// CurveSegment: a cubic Bezier curve with a width, and the rays that hit it.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "montelux/mc/math/vec.h"
#include "montelux/scene/shape/bounds.h"

namespace montelux {

using CubicBezier = std::array<Vec3d, 4>;

enum class CurveBasis { bezier, bspline };

// The curve through control points of a basis and a degree (2 or 3) as cubic Bezier curves. Bezier curves
// share their end points: 1 + n * degree control points give n of them. A uniform B-spline of n + degree
// control points gives n. Throws Error for other counts.
std::vector<CubicBezier> bezier_segments(std::span<const Point3f> points, CurveBasis basis, int degree);

Vec3d point_of(const CubicBezier& curve, double u);
Vec3d derivative_of(const CubicBezier& curve, double u);
// The halves u < 1/2 and u > 1/2.
std::array<CubicBezier, 2> split(const CubicBezier& curve);

struct CurveSegment {
    CubicBezier curve;
    double width0 = 1, width1 = 1; // at u = 0 and 1, linear between
    // Unit normals at u = 0 and 1: the surface is perpendicular to them. Without them it faces each ray.
    std::optional<std::array<Vec3d, 2>> normals;
};

// The unit normal at u, by spherical interpolation (Shoemake 1985). Only with normals.
Vec3d normal_of(const CurveSegment& segment, double u);

// A part of a segment: u0 <= u <= u1.
struct CurveRange {
    double u0 = 0, u1 = 1;
};

// Holds all points of the part of the surface, whichever way it faces.
Bounds3 bounds_of(const CurveSegment& segment, CurveRange range = {});

struct CurveHit {
    double t;
    double u, v; // u along the curve; v from 0 to 1 across its width, along direction x tangent
};

// The first hit of the ray o + t d on the part of the segment with t in (t_min, t_max).
std::optional<CurveHit> intersect(const CurveSegment& segment, Vec3d o, Vec3d d, double t_min, double t_max,
                                  CurveRange range = {});

} // namespace montelux
