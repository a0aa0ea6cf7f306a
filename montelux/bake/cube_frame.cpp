#include "montelux/bake/cube_frame.h"

#include <cmath>

#include "montelux/mc/math/constants.h"

namespace montelux {
namespace {

// About the map's up axis, towards larger longitudes for positive degrees.
Vec3d turned(Vec3d d, double degrees) {
    if (degrees == 0) return d;
    const double c = std::cos(degrees * pi / 180), s = std::sin(degrees * pi / 180);
    return {c * d.x - s * d.y, s * d.x + c * d.y, d.z};
}

} // namespace

// Longitude pi, the middle of an equirectangular map, is at (-1, 0, 0) of the map's frame, its right at (0,
// -1, 0).
Vec3d CubeFrame::to_map(Vec3d cube) const {
    Vec3d right_up_front = z_up ? Vec3d{cube.y, cube.z, cube.x} : cube;
    if (mirrored) right_up_front.x = -right_up_front.x;
    return turned({-right_up_front.z, -right_up_front.x, right_up_front.y}, turn);
}

Vec3d CubeFrame::from_map(Vec3d map) const {
    const Vec3d d = turned(map, -turn);
    Vec3d right_up_front{-d.y, d.z, -d.x};
    if (mirrored) right_up_front.x = -right_up_front.x;
    return z_up ? Vec3d{right_up_front.z, right_up_front.x, right_up_front.y} : right_up_front;
}

} // namespace montelux
