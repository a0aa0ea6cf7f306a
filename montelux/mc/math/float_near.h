// Inverses of rounded formulas: the float near a guess from which a formula gives exactly what it gave.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <optional>

namespace montelux {

// v moved by k floats up (down where k < 0); `v` finite, k small beside 2^31.
inline float moved_by_floats(float v, int k) {
    // In this order of integers floats ascend; both zeros are 0.
    const auto bits = std::bit_cast<std::int32_t>(v);
    const std::int32_t at = (bits < 0 ? INT32_MIN - bits : bits) + k;
    return std::bit_cast<float>(at < 0 ? INT32_MIN - at : at);
}

// v rounded to so many decimal digits.
inline float rounded_to_digits(double v, int digits) {
    char text[48];
    std::snprintf(text, sizeof text, "%.*g", digits, v);
    return static_cast<float>(std::strtod(text, nullptr));
}

// The first that fits of the guess rounded to 1, 2 ... 9 digits (what people write), and of the floats around it, at
// most `reach` away.
template <typename Fits>
std::optional<float> float_near(double guess, const Fits& fits, int reach = 64) {
    if (!std::isfinite(guess)) return std::nullopt;
    for (int digits = 1; digits <= 9; ++digits)
        if (const float v = rounded_to_digits(guess, digits); fits(v)) return v;
    const auto center = static_cast<float>(guess);
    float up = center, down = center;
    for (int k = 0; k <= reach; ++k) {
        if (fits(up)) return up;
        if (fits(down)) return down;
        up = moved_by_floats(up, 1);
        down = moved_by_floats(down, -1);
    }
    return std::nullopt;
}

} // namespace montelux
