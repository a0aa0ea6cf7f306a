// R_d: the additive sequences of the generalised golden ratio.
#pragma once

#include <cmath>
#include <cstdint>

#include "montelux/mc/random/uniform_bits.h"

namespace montelux {

// The positive root of x^(d+1) = x + 1: the golden ratio for d = 1, the plastic number for d = 2. Newton's
// method from above, where the function is convex.
inline long double generalised_golden_ratio(int dimensions) {
    const int degree = dimensions + 1;
    long double x = std::pow(3.0L, 1.0L / degree);
    for (int i = 0; i < 12; ++i) {
        const long double power = std::pow(x, static_cast<long double>(dimensions));
        x -= (power * x - x - 1) / (degree * power - 1);
    }
    return x;
}

// Step of dimension j in [0, d): ratio^-(j + 1), as a fraction of 2^64.
inline std::uint64_t golden_ratio_step(int dimension, long double ratio) {
    return static_cast<std::uint64_t>(std::pow(ratio, -(dimension + 1.0L)) * 0x1p64L);
}

// Coordinate of point i: the fractional part of 1/2 + (i + 1) step. Roberts 2018, "The Unreasonable
// Effectiveness of Quasirandom Sequences". Wrapping arithmetic keeps it exact to 2^-32 for all i < 2^32.
constexpr double golden_ratio_coordinate(std::uint64_t i, std::uint64_t step) {
    return unit_double((std::uint64_t{1} << 63) + (i + 1) * step);
}

} // namespace montelux
