// The unit sphere from the unit square and back, uniform in solid angle.
#pragma once

#include "montelux/mc/warp/disk.h"

namespace montelux {

// Per steradian.
template <std::floating_point T = float>
constexpr T uniform_sphere_pdf() {
    return static_cast<T>(inv_four_pi);
}

// Archimedes: z = 1 - 2 u.x, phi = 2 pi u.y. The radius 2 sqrt(u (1 - u)) keeps its digits at the poles,
// where sqrt(1 - z^2) loses them.
template <std::floating_point T = float>
Vec3<T> sample_uniform_sphere(Vec2<T> u) {
    T sin_theta = 2 * std::sqrt(u.x * (1 - u.x)), phi = static_cast<T>(2 * pi) * u.y;
    return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), 1 - 2 * u.x};
}
template <std::floating_point T = float>
Vec2<T> invert_uniform_sphere(Vec3<T> w) {
    // (1 - z) / 2 = sin^2(theta) / (2 (1 + z)) in the upper hemisphere.
    T half_versine = w.z > 0 ? (w.x * w.x + w.y * w.y) / (2 * (1 + w.z)) : (1 - w.z) / 2;
    return {std::min(half_versine, T(1)), turn_fraction(w.x, w.y)};
}

} // namespace montelux
