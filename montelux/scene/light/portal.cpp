#include "montelux/scene/light/portal.h"

#include <cmath>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"

namespace montelux {

Portal::Portal(const std::array<Point3f, 4>& corners) : corners_(corners), corner_(corners[0]) {
    constexpr double tolerance = 0.001; // pbrt-v4's
    std::array<Vec3d, 4> edges;         // each from its corner to the next one
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3d edge = Vec3d(corners[(i + 1) % 4]) - Vec3d(corners[i]);
        const double l = length(edge);
        if (!(l > 0 && std::isfinite(l))) throw Error("two corners of the portal are the same point");
        edges[i] = edge / l;
    }
    for (std::size_t i = 0; i < 2; ++i)
        if (!(std::abs(dot(edges[i], edges[i + 2]) + 1) <= tolerance))
            throw Error("the portal is no rectangle: opposite edges are not parallel");
    for (std::size_t i = 0; i < 4; ++i)
        if (!(std::abs(dot(edges[i], edges[(i + 1) % 4])) <= tolerance))
            throw Error("the portal is no rectangle: edges are not perpendicular");
    x_ = -edges[3];
    z_ = normalize(cross(x_, edges[0]));
    y_ = cross(z_, x_);
    const Vec3d diagonal = Vec3d(corners[2]) - corner_;
    width_ = dot(diagonal, x_);
    height_ = dot(diagonal, y_);
}

Window2D Portal::hemisphere() { return {{-pi / 2, -pi / 2}, {pi / 2, pi / 2}}; }

std::optional<Window2D> Portal::window(Point3f p) const {
    const Vec3d d = to_local(corner_ - Vec3d(p));
    if (!(d.z > 0)) return std::nullopt;
    return Window2D{{std::atan2(d.x, d.z), std::atan2(d.y, d.z)},
                    {std::atan2(d.x + width_, d.z), std::atan2(d.y + height_, d.z)}};
}

std::optional<Vec2d> Portal::angles(Vec3d w) const {
    const Vec3d l = to_local(w);
    if (!(l.z > 0)) return std::nullopt;
    return Vec2d{std::atan2(l.x, l.z), std::atan2(l.y, l.z)};
}

// (x, y, z) / |(x, y, z)| of x = tan(alpha), y = tan(beta), z = 1, without infinite tangents.
Vec3d Portal::local_direction(Vec2d a) {
    const double sx = std::sin(a.x), cx = std::cos(a.x), sy = std::sin(a.y), cy = std::cos(a.y);
    return normalize(Vec3d{sx * cy, sy * cx, cx * cy});
}

bool Portal::lets_through(Point3f p, Vec3f w) const {
    const Vec3d to_corner = to_local(corner_ - Vec3d(p)), l = to_local(Vec3d(w));
    if (!(to_corner.z > 0 && l.z > 0)) return false;
    const double t = to_corner.z / l.z, x = t * l.x - to_corner.x, y = t * l.y - to_corner.y;
    return x >= 0 && x < width_ && y >= 0 && y < height_;
}

std::optional<SphericalRectangle> Portal::seen_from(Point3f p) const {
    if (!window(p)) return std::nullopt;
    return SphericalRectangle::from_corner(Vec3d(p), corner_, x_ * width_, y_ * height_);
}

} // namespace montelux
