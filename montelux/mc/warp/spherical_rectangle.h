// A rectangle seen from a point, sampled uniformly in solid angle.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <optional>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/vec.h"

namespace montelux {

// Urena, Fajardo and King 2013, "An Area-Preserving Parametrization for Spherical Rectangles". Works in
// double: the spherical excess of a small rectangle is a difference of near numbers.
class SphericalRectangle {
  public:
    // The rectangle corner + s edge_x + t edge_y, s and t in [0, 1], seen from `from`; the edges must be
    // orthogonal. Empty when it spans no solid angle: an edge of no length, or `from` in its plane.
    static std::optional<SphericalRectangle> from_corner(Vec3d from, Vec3d corner, Vec3d edge_x,
                                                         Vec3d edge_y) {
        SphericalRectangle r;
        double lx = length(edge_x), ly = length(edge_y);
        if (!(lx > 0 && ly > 0)) return std::nullopt;
        r.from_ = from;
        r.x_ = edge_x / lx;
        r.y_ = edge_y / ly;
        r.z_ = cross(r.x_, r.y_);
        Vec3d d = corner - from;
        r.z0_ = dot(d, r.z_);
        if (r.z0_ > 0) { // the paper's rectangle lies below the origin
            r.z_ = -r.z_;
            r.z0_ = -r.z0_;
        }
        r.x0_ = dot(d, r.x_);
        r.y0_ = dot(d, r.y_);
        r.x1_ = r.x0_ + lx;
        r.y1_ = r.y0_ + ly;
        if (!(r.z0_ < 0)) return std::nullopt;
        r.solid_angle_ = r.strip_area(r.x1_);
        if (!(r.solid_angle_ > 0)) return std::nullopt;
        // z components of the unit normals of the planes through the origin and the edges y0 and y1, and
        // the two internal angles at the corners on x0: k = 2 pi - (g2 + g3).
        r.b0_ = -r.y0_ / std::hypot(r.y0_, r.z0_);
        r.b1_ = r.y1_ / std::hypot(r.y1_, r.z0_);
        double nx = -r.x0_ / std::hypot(r.x0_, r.z0_); // of the plane through the edge x0
        r.k_ = 2 * pi - std::acos(-nx * r.b1_) - std::acos(-nx * r.b0_);
        return r;
    }

    // In steradians.
    double solid_angle() const { return solid_angle_; }
    // Per steradian, for directions within the rectangle.
    template <std::floating_point T = float>
    T pdf() const {
        return static_cast<T>(1 / solid_angle_);
    }

    // A point of the rectangle in world space whose direction is uniform in solid angle.
    template <std::floating_point T>
    Vec3<T> sample_point(Vec2<T> u) const {
        return Vec3<T>(from_ + to_point(Vec2d(static_cast<double>(u.x), static_cast<double>(u.y))));
    }
    // The unit direction to that point.
    template <std::floating_point T>
    Vec3<T> sample(Vec2<T> u) const {
        return Vec3<T>(normalize(to_point(Vec2d(static_cast<double>(u.x), static_cast<double>(u.y)))));
    }
    // The u that `sample` maps to the unit direction w within the rectangle.
    template <std::floating_point T>
    Vec2<T> inverse(Vec3<T> direction) const {
        Vec3d w(direction);
        double t = z0_ / dot(w, z_);
        double xu = std::clamp(t * dot(w, x_), x0_, x1_), yv = std::clamp(t * dot(w, y_), y0_, y1_);
        double d = std::hypot(xu, z0_);
        double h0 = y0_ / std::hypot(d, y0_), h1 = y1_ / std::hypot(d, y1_), h = yv / std::hypot(d, yv);
        return {static_cast<T>(std::clamp(strip_area(xu) / solid_angle_, 0.0, 1.0)),
                static_cast<T>(std::clamp((h - h0) / (h1 - h0), 0.0, 1.0))};
    }

  private:
    SphericalRectangle() = default;

    // Solid angle of the part with x0 <= x <= to.
    double strip_area(double to) const {
        auto quadrant = [&](double x, double y) {
            return std::atan2(x * y, -z0_ * std::sqrt(x * x + y * y + z0_ * z0_));
        };
        return quadrant(to, y1_) - quadrant(x0_, y1_) - quadrant(to, y0_) + quadrant(x0_, y0_);
    }
    Vec3d to_point(Vec2d u) const {
        double angle = u.x * solid_angle_ + k_;
        double fu = (std::cos(angle) * b0_ - b1_) / std::sin(angle);
        double cu = std::copysign(1 / std::hypot(fu, b0_), fu);
        cu = std::clamp(cu, -1.0, 1.0);
        double xu = std::clamp(-cu * z0_ / std::sqrt((1 - cu) * (1 + cu)), x0_, x1_);
        double d = std::hypot(xu, z0_);
        double h0 = y0_ / std::hypot(d, y0_), h1 = y1_ / std::hypot(d, y1_);
        double h = h0 + u.y * (h1 - h0);
        double cos2 = (1 - h) * (1 + h);
        double yv = cos2 > 0 ? std::clamp(h * d / std::sqrt(cos2), y0_, y1_) : (h < 0 ? y0_ : y1_);
        return x_ * xu + y_ * yv + z_ * z0_;
    }

    Vec3d from_, x_, y_, z_;
    double x0_ = 0, x1_ = 0, y0_ = 0, y1_ = 0, z0_ = 0;
    double b0_ = 0, b1_ = 0, k_ = 0, solid_angle_ = 0;
};

} // namespace montelux
