// The whole sphere from the unit square and back, equal in area: the octahedral layout of square
// environment maps.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/vec.h"

namespace montelux {

// Clarberg 2008, "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD", JGT 13(3). The centre of the
// square is +z, its four corners are -z, the inner diamond |2x-1| + |2y-1| = 1 is the equator; this is
// the layout of pbrt-v4's environment maps. Density on the sphere is that on the square / (4 pi).

template <std::floating_point T = float>
Vec3<T> equal_area_square_to_sphere(Vec2<T> p) {
    T u = 2 * p.x - 1, v = 2 * p.y - 1;
    T au = std::abs(u), av = std::abs(v);
    // Distance to the equator, positive in the upper hemisphere; r is the concentric-disk radius.
    T to_equator = 1 - (au + av);
    T r = 1 - std::abs(to_equator);
    T phi = r == 0 ? T(0) : static_cast<T>(pi / 4) * ((av - au) / r + 1);
    T r2 = r * r;
    T sin_theta = r * std::sqrt(2 - r2);
    return {std::copysign(sin_theta * std::cos(phi), u), std::copysign(sin_theta * std::sin(phi), v),
            std::copysign(1 - r2, to_equator)};
}

// w must have unit length.
template <std::floating_point T = float>
Vec2<T> equal_area_sphere_to_square(Vec3<T> w) {
    T x = std::abs(w.x), y = std::abs(w.y);
    // r^2 = 1 - |z| without cancellation near the poles.
    T r = std::min(T(1), std::sqrt((x * x + y * y) / (1 + std::abs(w.z))));
    T turn = x == 0 && y == 0 ? T(0) : std::atan2(y, x) * static_cast<T>(2 * inv_pi); // quarter turns
    T v = turn * r, u = r - v;
    if (w.z < 0) {
        T folded = 1 - v;
        v = 1 - u;
        u = folded;
    }
    return {std::clamp((std::copysign(u, w.x) + 1) / 2, T(0), T(1)),
            std::clamp((std::copysign(v, w.y) + 1) / 2, T(0), T(1))};
}

// The point of the square that continues it across its edges, for filters that reach up to one square
// beyond: each edge is glued to itself, turned about its middle.
template <std::floating_point T = float>
constexpr Vec2<T> wrap_equal_area_square(Vec2<T> p) {
    if (p.x < 0) {
        p = {-p.x, 1 - p.y};
    } else if (p.x > 1) {
        p = {2 - p.x, 1 - p.y};
    }
    if (p.y < 0) {
        p = {1 - p.x, -p.y};
    } else if (p.y > 1) {
        p = {1 - p.x, 2 - p.y};
    }
    return p;
}

} // namespace montelux
