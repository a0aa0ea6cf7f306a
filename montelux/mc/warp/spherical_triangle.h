// A triangle of directions (a triangle seen from a point), sampled uniformly in solid angle.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <optional>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/vec.h"

namespace montelux {

// Arvo 1995, "Stratified Sampling of Spherical Triangles". Works in double: the float versions break down
// for triangles that look small.
class SphericalTriangle {
  public:
    // The triangle of the directions to three points from the origin; they need not have unit length.
    // Empty when it spans no solid angle: degenerate, seen edge-on, or with a corner at the origin.
    static std::optional<SphericalTriangle> from_directions(Vec3d a, Vec3d b, Vec3d c) {
        double la = length(a), lb = length(b), lc = length(c);
        if (!(la > 0 && lb > 0 && lc > 0)) return std::nullopt;
        SphericalTriangle t(a / la, b / lb, c / lc);
        if (!(t.solid_angle_ > 0 && t.n_ab_ > 0 && t.n_ac_ > 0)) return std::nullopt;
        return t;
    }

    // In steradians.
    double solid_angle() const { return solid_angle_; }
    // Per steradian, for directions within the triangle.
    template <std::floating_point T = float>
    T pdf() const {
        return static_cast<T>(1 / solid_angle_);
    }

    // u.x picks the corner on the arc from A to C that cuts off u.x of the area, u.y the point on the arc
    // from B to that corner.
    template <std::floating_point T>
    Vec3<T> sample(Vec2<T> u) const {
        double area = static_cast<double>(u.x) * solid_angle_;
        // Arvo's (s, t) are the sine and cosine of area - alpha.
        double sin_area = std::sin(area), cos_area = std::cos(area);
        double s = sin_area * cos_alpha_ - cos_area * sin_alpha_;
        double t = cos_area * cos_alpha_ + sin_area * sin_alpha_;
        double p = t - cos_alpha_, r = s + sin_alpha_ * cos_c_;
        double denominator = (r * s + p * t) * sin_alpha_;
        double q = denominator != 0 ? ((r * t - p * s) * cos_alpha_ - r) / denominator : 1;
        q = std::clamp(q, -1.0, 1.0);
        Vec3d corner = a_ * q + c_from_a_ * std::sqrt((1 - q) * (1 + q));
        double versine = static_cast<double>(u.y) * 0.5 * length_squared(corner - b_);
        Vec3d away = corner - b_ * dot(corner, b_);
        double away2 = length_squared(away);
        if (!(away2 > 0)) return Vec3<T>(b_);
        return Vec3<T>(b_ * (1 - versine) + away * std::sqrt(versine * (2 - versine) / away2));
    }
    // The u that `sample` maps to the unit direction w within the triangle.
    template <std::floating_point T>
    Vec2<T> inverse(Vec3<T> direction) const {
        Vec3d w(direction);
        // The arc from B through w meets the arc A-C in the corner.
        Vec3d corner = cross(cross(b_, w - b_), cross(c_, a_ - c_));
        double len = length(corner);
        if (!(len > 0)) return {0, 0};
        corner = corner / (dot(corner, a_ + c_) < 0 ? -len : len);
        double area = area_of(a_, b_, corner);
        double whole = length_squared(corner - b_);
        double u = std::clamp(area / solid_angle_, 0.0, 1.0);
        double v = whole > 0 ? std::clamp(length_squared(w - b_) / whole, 0.0, 1.0) : 0.0;
        return {static_cast<T>(u), static_cast<T>(v)};
    }

    // Solid angle of the triangle of unit directions. Van Oosterom and Strackee 1983, "The Solid Angle of
    // a Plane Triangle"; the triple product is taken from the edges, which small triangles need.
    static double area_of(Vec3d a, Vec3d b, Vec3d c) {
        double triple = std::abs(dot(a, cross(b - a, c - a)));
        return 2 * std::atan2(triple, 1 + dot(a, b) + dot(b, c) + dot(c, a));
    }

  private:
    SphericalTriangle(Vec3d a, Vec3d b, Vec3d c) : a_(a), b_(b), c_(c), solid_angle_(area_of(a, b, c)) {
        Vec3d ab = cross(a, b - a), ac = cross(a, c - a);
        n_ab_ = length(ab);
        n_ac_ = length(ac);
        double triple = std::abs(dot(a, cross(b - a, c - a)));
        double inv = 1 / std::hypot(triple, dot(ab, ac));
        cos_alpha_ = dot(ab, ac) * inv;
        sin_alpha_ = triple * inv;
        cos_c_ = dot(a, b);
        c_from_a_ = normalize(cross(ac, a));
    }

    Vec3d a_, b_, c_;
    Vec3d c_from_a_; // unit, orthogonal to a, towards c
    double solid_angle_, n_ab_ = 0, n_ac_ = 0;
    double cos_alpha_ = 1, sin_alpha_ = 0; // angle at a
    double cos_c_ = 1;                     // arc from a to b
};

} // namespace montelux
