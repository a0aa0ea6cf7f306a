// The upper unit hemisphere (around +z) from the unit square and back: uniform and cosine-weighted.
#pragma once

#include "montelux/mc/warp/disk.h"

namespace montelux {

// Per steradian, for directions with z >= 0.
template <std::floating_point T = float>
constexpr T uniform_hemisphere_pdf() {
    return static_cast<T>(inv_two_pi);
}

// z = 1 - u.x (never 0 for u.x < 1), phi = 2 pi u.y.
template <std::floating_point T = float>
Vec3<T> sample_uniform_hemisphere(Vec2<T> u) {
    T sin_theta = std::sqrt(u.x * (2 - u.x)), phi = static_cast<T>(2 * pi) * u.y;
    return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), 1 - u.x};
}
template <std::floating_point T = float>
Vec2<T> invert_uniform_hemisphere(Vec3<T> w) {
    T versine = (w.x * w.x + w.y * w.y) / (1 + w.z);
    return {std::min(versine, T(1)), turn_fraction(w.x, w.y)};
}

// Per steradian; zero at and below the horizon.
template <Number T = float>
constexpr T cosine_hemisphere_pdf(T cos_theta) {
    return select(cos_theta > 0, cos_theta * static_cast<ScalarOf<T>>(inv_pi), T(0));
}

// Malley's method: the concentric disk lifted to the sphere. Points on the rim of the square lie on the
// horizon, where the density is zero: test it before dividing.
template <Number T = float>
Vec3<T> sample_cosine_hemisphere(Vec2<T> u) {
    using std::abs, std::max, std::sqrt;
    const Vec2<T> d = sample_uniform_disk_concentric(u);
    // The disk radius is max(|a|, |b|) with a, b = 2u - 1, known exactly; 1 - x^2 - y^2 is not.
    const T r = max(abs(2 * u.x - 1), abs(2 * u.y - 1));
    return {d.x, d.y, sqrt((1 - r) * (1 + r))};
}
template <std::floating_point T = float>
Vec2<T> invert_cosine_hemisphere(Vec3<T> w) {
    return invert_uniform_disk_concentric(Vec2<T>{w.x, w.y});
}

} // namespace montelux
