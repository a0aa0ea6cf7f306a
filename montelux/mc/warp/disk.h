// The unit disk from the unit square and back: polar and concentric maps, both uniform in area.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/sin_cos.h"
#include "montelux/mc/math/vec.h"

namespace montelux {

// Per unit area of the unit disk.
template <std::floating_point T = float>
constexpr T uniform_disk_pdf() {
    return static_cast<T>(inv_pi);
}

// Angle of (x, y) as a fraction of the full turn, in [0, 1).
template <std::floating_point T>
T turn_fraction(T x, T y) {
    T f = std::atan2(y, x) * static_cast<T>(inv_two_pi);
    if (f < 0) f += T(1);
    return f < T(1) ? f : T(0);
}

// r = sqrt(u.x), phi = 2 pi u.y.
template <std::floating_point T = float>
Vec2<T> sample_uniform_disk_polar(Vec2<T> u) {
    T r = std::sqrt(u.x), phi = static_cast<T>(2 * pi) * u.y;
    return {r * std::cos(phi), r * std::sin(phi)};
}
template <std::floating_point T = float>
Vec2<T> invert_uniform_disk_polar(Vec2<T> p) {
    return {std::min(length_squared(p), T(1)), turn_fraction(p.x, p.y)};
}

// Squares around the centre become circles; neighbours stay neighbours, with little distortion.
// Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square", JGT 2(3).
template <Number T = float>
Vec2<T> sample_uniform_disk_concentric(Vec2<T> u) {
    using std::abs;
    const T a = 2 * u.x - 1, b = 2 * u.y - 1;
    const MaskOf<T> steep = !(abs(a) > abs(b));
    const T r = select(steep, b, a), minor = select(steep, a, b);
    // The angle to the axis that is nearer, at most an eighth of a turn; at the centre any will do.
    const T share = minor / select(r == 0, T(1), r);
    const auto [sine, cosine] = sin_cos_octant(static_cast<ScalarOf<T>>(pi / 4) * share);
    return {r * select(steep, sine, cosine), r * select(steep, cosine, sine)};
}
template <std::floating_point T = float>
Vec2<T> invert_uniform_disk_concentric(Vec2<T> p) {
    constexpr T four_over_pi = static_cast<T>(4 * inv_pi);
    T r = std::min(length(p), T(1));
    T a, b; // in [-1, 1]
    if (std::abs(p.x) > std::abs(p.y)) {
        a = std::copysign(r, p.x);
        b = a * four_over_pi * std::atan(p.y / p.x);
    } else if (p.y != 0) {
        b = std::copysign(r, p.y);
        a = b * four_over_pi * std::atan(p.x / p.y);
    } else {
        a = b = 0;
    }
    return {(a + 1) / 2, (b + 1) / 2};
}

} // namespace montelux
