// Linear and bilinear densities on the unit interval and square.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>

#include "montelux/mc/math/vec.h"

namespace montelux {

// Density 2 ((1 - x) a + x b) / (a + b) on [0, 1), a and b >= 0, not both 0. With a = 0 this is p = 2x,
// X = sqrt(u).
template <std::floating_point T>
constexpr T linear_pdf(T x, T a, T b) {
    return x >= 0 && x <= 1 ? 2 * (a + x * (b - a)) / (a + b) : T(0);
}
template <std::floating_point T>
T sample_linear(T u, T a, T b) {
    // Root of a x + (b - a) x^2 / 2 = u (a + b) / 2 in the form without cancellation.
    if (u == 0 && a == 0) return 0;
    T root = std::sqrt(a * a + u * (b - a) * (b + a));
    return std::min(u * (a + b) / (a + root), T(1));
}
template <std::floating_point T>
constexpr T invert_linear(T x, T a, T b) {
    return x * (2 * a + x * (b - a)) / (a + b);
}

// Density proportional to the bilinear interpolation of the corner values {f(0,0), f(1,0), f(0,1), f(1,1)},
// all >= 0, not all 0: y by its marginal, then x.
template <std::floating_point T>
constexpr T bilinear_pdf(Vec2<T> p, const std::array<T, 4>& f) {
    if (!(p.x >= 0 && p.x <= 1 && p.y >= 0 && p.y <= 1)) return 0;
    T low = f[0] + p.x * (f[1] - f[0]), high = f[2] + p.x * (f[3] - f[2]);
    return 4 * (low + p.y * (high - low)) / (f[0] + f[1] + f[2] + f[3]);
}
template <std::floating_point T>
Vec2<T> sample_bilinear(Vec2<T> u, const std::array<T, 4>& f) {
    T y = sample_linear(u.y, f[0] + f[1], f[2] + f[3]);
    T x = sample_linear(u.x, f[0] + y * (f[2] - f[0]), f[1] + y * (f[3] - f[1]));
    return {x, y};
}
template <std::floating_point T>
constexpr Vec2<T> invert_bilinear(Vec2<T> p, const std::array<T, 4>& f) {
    return {invert_linear(p.x, f[0] + p.y * (f[2] - f[0]), f[1] + p.y * (f[3] - f[1])),
            invert_linear(p.y, f[0] + f[1], f[2] + f[3])};
}

} // namespace montelux
