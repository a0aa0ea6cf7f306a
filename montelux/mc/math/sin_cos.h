// Sine and cosine together, for number types.
#pragma once

#include <cmath>

#include "montelux/mc/math/number.h"

namespace montelux {

template <Number T>
struct SinCos {
    T sine, cosine;
};

// For |x| <= pi/4. In floats Taylor series, within 1e-7; in doubles those of the standard library.
template <Number T>
SinCos<T> sin_cos_octant(T x) {
    if constexpr (std::same_as<T, double>) {
        return {std::sin(x), std::cos(x)};
    } else {
        const T z = x * x;
        const T s = (((z * (1.0f / 362880) - 1.0f / 5040) * z + 1.0f / 120) * z - 1.0f / 6) * z;
        const T c = (((z * (1.0f / 40320) - 1.0f / 720) * z + 1.0f / 24) * z - 0.5f) * z;
        return {x + x * s, 1 + c};
    }
}

} // namespace montelux
