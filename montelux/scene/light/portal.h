// Portal: a rectangle through which the light of an infinite light enters.
#pragma once

#include <array>
#include <optional>

#include "montelux/mc/dist/windowed_2d.h"
#include "montelux/mc/math/vec.h"
#include "montelux/mc/warp/spherical_rectangle.h"

namespace montelux {

// Light comes from the side to which cross(corners[3] - corners[0], corners[1] - corners[0]) points, and
// reaches only points on the other side, through the rectangle: pbrt-v4's parameter 'portal'.
//
// Directions through the portal's plane are written as two angles, alpha = atan(x / z) and beta = atan(y / z)
// in the frame of its edges, z to the light. From any point the portal is then an axis-aligned rectangle
// (Bitterli, Novak, Jarosz 2015, "Portal-Masked Environment Map Sampling").
class Portal {
  public:
    // In order around the rectangle, in world space. Throws Error if they form no rectangle; the cosines of
    // its angles may deviate by 0.001. Two corners, on a diagonal, are kept exactly.
    explicit Portal(const std::array<Point3f, 4>& corners);

    const std::array<Point3f, 4>& corners() const { return corners_; }
    double area() const { return width_ * height_; }
    // The point at coordinates in [0, 1]^2 along the edges.
    Vec3d point(Vec2d at) const { return corner_ + x_ * (width_ * at.x) + y_ * (height_ * at.y); }
    // Towards the light.
    Vec3d normal() const { return z_; }

    // The window of all directions to the light.
    static Window2D hemisphere();
    // The window of angles in which `p` sees the portal; empty if no light reaches it.
    std::optional<Window2D> window(Point3f p) const;
    // The angles of a direction; empty if it does not point to the light's side.
    std::optional<Vec2d> angles(Vec3d w) const;
    // The frame of the edges, z to the light.
    Vec3d to_local(Vec3d w) const { return {dot(w, x_), dot(w, y_), dot(w, z_)}; }
    Vec3d to_world(Vec3d local) const { return x_ * local.x + y_ * local.y + z_ * local.z; }
    // Unit, in that frame.
    static Vec3d local_direction(Vec2d angles);
    Vec3d direction(Vec2d angles) const { return to_world(local_direction(angles)); }
    // Whether a ray from `p` along `w` passes through it.
    bool lets_through(Point3f p, Vec3f w) const;
    // The rectangle as seen from `p`; empty if no light reaches `p`.
    std::optional<SphericalRectangle> seen_from(Point3f p) const;

    // Solid angle per area of the plane of angles, in a direction of unit length to the light's side. With
    // x = tan(alpha), y = tan(beta) and r^2 = 1 + x^2 + y^2: dx dy / r^3 = (1 + x^2) (1 + y^2) / r^3 d(alpha)
    // d(beta).
    static double solid_angle_density(Vec3d local) {
        const double x2 = local.x * local.x, y2 = local.y * local.y, z2 = local.z * local.z;
        return (x2 + z2) * (y2 + z2) / local.z;
    }

  private:
    std::array<Point3f, 4> corners_;
    Vec3d corner_, x_, y_, z_;
    double width_ = 0, height_ = 0;
};

} // namespace montelux
