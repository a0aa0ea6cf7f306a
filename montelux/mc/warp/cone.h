// The cone of directions around +z from the unit square and back, uniform in solid angle.
#pragma once

#include "montelux/mc/warp/disk.h"

namespace montelux {

// Narrow cones are described by their versine 1 - cos(theta): the cosine itself has no digits left there.
// The versine of the angle whose squared sine is given (theta <= pi/2), without cancellation.
template <std::floating_point T>
T versine_from_sin_squared(T sin_squared) {
    return sin_squared / (1 + std::sqrt(std::max(T(0), 1 - sin_squared)));
}

// Per steradian, for directions within the cone; infinite for a cone without width.
template <std::floating_point T>
constexpr T uniform_cone_pdf_from_versine(T versine_max) {
    return static_cast<T>(inv_two_pi) / versine_max;
}
template <std::floating_point T>
constexpr T uniform_cone_pdf(T cos_theta_max) {
    return uniform_cone_pdf_from_versine(1 - cos_theta_max);
}

// 1 - cos(theta) = u.x versine_max, phi = 2 pi u.y; versine_max in [0, 2].
template <std::floating_point T>
Vec3<T> sample_uniform_cone_from_versine(Vec2<T> u, T versine_max) {
    T v = u.x * versine_max;
    T sin_theta = std::sqrt(v * (2 - v)), phi = static_cast<T>(2 * pi) * u.y;
    return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), 1 - v};
}
template <std::floating_point T>
Vec3<T> sample_uniform_cone(Vec2<T> u, T cos_theta_max) {
    return sample_uniform_cone_from_versine(u, 1 - cos_theta_max);
}

// w must lie within the cone; u.x is clamped to 1.
template <std::floating_point T>
Vec2<T> invert_uniform_cone_from_versine(Vec3<T> w, T versine_max) {
    T versine = w.z > 0 ? (w.x * w.x + w.y * w.y) / (1 + w.z) : 1 - w.z;
    return {std::min(versine / versine_max, T(1)), turn_fraction(w.x, w.y)};
}
template <std::floating_point T>
Vec2<T> invert_uniform_cone(Vec3<T> w, T cos_theta_max) {
    return invert_uniform_cone_from_versine(w, 1 - cos_theta_max);
}

} // namespace montelux
