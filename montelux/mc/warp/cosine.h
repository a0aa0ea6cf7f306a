// The cosine density on [0, pi/2) and the quadratic density on [-1, 1].
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "montelux/mc/math/constants.h"

namespace montelux {

// Density cos x on [0, pi/2): X = asin u.
template <std::floating_point T>
T cosine_pdf(T x) {
    return x >= 0 && x < static_cast<T>(pi / 2) ? std::cos(x) : T(0);
}
template <std::floating_point T>
T sample_cosine(T u) {
    return std::asin(u);
}
template <std::floating_point T>
T invert_cosine(T x) {
    return std::sin(x);
}

// Density 3 x^2 / 2 on [-1, 1]: X = cbrt(2u - 1).
template <std::floating_point T>
constexpr T quadratic_pdf(T x) {
    return x >= -1 && x <= 1 ? T(1.5) * x * x : T(0);
}
template <std::floating_point T>
T sample_quadratic(T u) {
    return std::cbrt(2 * u - 1);
}
template <std::floating_point T>
constexpr T invert_quadratic(T x) {
    return (x * x * x + 1) / 2;
}

} // namespace montelux
