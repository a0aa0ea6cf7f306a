// The tent (triangle filter) density on a symmetric interval.
#pragma once

#include <cmath>
#include <concepts>

namespace montelux {

// Density (radius - |x|) / radius^2 on [-radius, radius].
template <std::floating_point T>
constexpr T tent_pdf(T x, T radius) {
    T a = x < 0 ? -x : x;
    return a < radius ? (radius - a) / (radius * radius) : T(0);
}
template <std::floating_point T>
T sample_tent(T u, T radius) {
    return u < T(0.5) ? radius * (std::sqrt(2 * u) - 1) : radius * (1 - std::sqrt(2 * (1 - u)));
}
template <std::floating_point T>
constexpr T invert_tent(T x, T radius) {
    T a = (radius - (x < 0 ? -x : x)) / radius; // distance to the nearer end
    T tail = a > 0 ? a * a / 2 : T(0);
    return x < 0 ? tail : 1 - tail;
}

} // namespace montelux
