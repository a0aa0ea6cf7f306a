// IEEE 754 binary16 stored as its 16 bits: conversion to and from float, round to nearest even, by Imath.
#pragma once

#include <Imath/half.h>
#include <cstdint>

namespace montelux {

inline float half_to_float(std::uint16_t h) { return imath_half_to_float(h); }

// Values from 65520 become infinite; NaN stays NaN.
inline std::uint16_t float_to_half(float f) { return imath_float_to_half(f); }

} // namespace montelux
