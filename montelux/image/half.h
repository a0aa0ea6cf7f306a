// IEEE 754 binary16 stored as its 16 bits: conversion to and from float, round to nearest even, by Imath.
#pragma once

#include <Imath/half.h>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace montelux {

inline float half_to_float(std::uint16_t h) { return imath_half_to_float(h); }

// Values from 65520 become infinite; NaN stays NaN.
inline std::uint16_t float_to_half(float f) { return imath_float_to_half(f); }

inline constexpr float largest_half = 65504;
// Finite values beyond the range of halfs become its ends.
inline std::uint16_t clamped_half(float f) {
    return float_to_half(std::isfinite(f) ? std::clamp(f, -largest_half, largest_half) : f);
}

} // namespace montelux
