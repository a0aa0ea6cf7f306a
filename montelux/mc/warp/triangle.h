// The flat triangle from the unit square and back: uniform barycentric coordinates.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "montelux/mc/math/vec.h"

namespace montelux {

// Barycentric coordinates (b0, b1, b2) sum to 1: the point is b0 v0 + b1 v1 + b2 v2.

// Per unit area of a triangle of this area.
template <std::floating_point T>
constexpr T uniform_triangle_pdf(T area) {
    return 1 / area;
}

// b0 = 1 - sqrt(1 - u.x), b1 = u.y sqrt(1 - u.x). Turk 1990, "Generating Random Points in Triangles",
// Graphics Gems I.
template <Number T = float>
Vec3<T> sample_uniform_triangle(Vec2<T> u) {
    using std::sqrt;
    const T s = sqrt(1 - u.x);
    return {u.x / (1 + s), u.y * s, (1 - u.y) * s};
}
template <std::floating_point T = float>
Vec2<T> invert_uniform_triangle(Vec3<T> b) {
    T s = b.y + b.z;
    return {std::clamp(b.x * (1 + s), T(0), T(1)), s > 0 ? b.y / s : T(0)};
}

// Shears either half of the square onto its half of the triangle: continuous, area preserving, and half
// the distortion of the square root map, so stratified points stay stratified.
// Heitz 2019, "A Low-Distortion Map Between Triangle and Square".
template <std::floating_point T = float>
Vec3<T> sample_uniform_triangle_low_distortion(Vec2<T> u) {
    T b0, b1;
    if (u.x < u.y) {
        b0 = u.x / 2;
        b1 = u.y - b0;
    } else {
        b1 = u.y / 2;
        b0 = u.x - b1;
    }
    return {b0, b1, std::max(T(0), 1 - b0 - b1)};
}
template <std::floating_point T = float>
Vec2<T> invert_uniform_triangle_low_distortion(Vec3<T> b) {
    if (b.x < b.y) return {2 * b.x, b.y + b.x};
    return {b.x + b.y, 2 * b.y};
}

} // namespace montelux
