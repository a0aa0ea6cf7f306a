// Four floats in one vector register: the arithmetic under spectra and wavelengths.
#pragma once

#include <bit>
#include <cstdint>

#include "montelux/mc/math/vec.h"

namespace montelux {

// The compiler's own vector type: + - * / and comparisons work lane by lane.
typedef float Float4 __attribute__((vector_size(16)));
typedef std::int32_t Int4 __attribute__((vector_size(16)));

inline Float4 broadcast(float v) { return Float4{v, v, v, v}; }

// Lane by lane `mask ? a : b`; a comparison of two Float4 makes the mask (-1 or 0 in each lane).
inline Float4 select(Int4 mask, Float4 a, Float4 b) { return mask ? a : b; }
inline Float4 min(Float4 a, Float4 b) { return a < b ? a : b; }
inline Float4 max(Float4 a, Float4 b) { return a > b ? a : b; }
inline bool any(Int4 mask) { return (mask[0] | mask[1] | mask[2] | mask[3]) != 0; }
inline float sum(Float4 v) { return (v[0] + v[1]) + (v[2] + v[3]); }
inline Float4 sqrt(Float4 v) {
#ifdef __SSE__
    return __builtin_ia32_sqrtps(v);
#else
    return Float4{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])};
#endif
}

// e^x within 3e-7 relative for x in [-87, 88]; 0 below that, infinity above, NaN for NaN.
inline Float4 exp(Float4 x) {
    // x = n ln 2 + r with |r| <= ln(2)/2; adding 1.5 2^23 rounds to the nearest integer.
    const Float4 magic = broadcast(12582912.0f);
    Float4 clamped = min(max(x, broadcast(-88.0f)), broadcast(89.0f));
    Float4 shifted = clamped * 1.44269504f + magic;
    Float4 n = shifted - magic;
    Float4 r = (clamped - n * 0.693359375f) + n * 2.12194440e-4f; // ln 2 in two parts
    // Taylor series: the first term left out is below 6e-9 of the sum.
    Float4 p = broadcast(1.0f / 5040);
    p = p * r + 1.0f / 720;
    p = p * r + 1.0f / 120;
    p = p * r + 1.0f / 24;
    p = p * r + 1.0f / 6;
    p = p * r + 0.5f;
    p = p * r + 1.0f;
    p = p * r + 1.0f;
    // 2^n by way of the exponent bits, in two factors so that 2^128 and 2^-127 do not wrap around.
    Int4 exponent = __builtin_convertvector(n, Int4);
    Int4 half = exponent >> 1;
    Int4 low = (half + 127) << 23, high = (exponent - half + 127) << 23;
    Float4 result = p * std::bit_cast<Float4>(low) * std::bit_cast<Float4>(high);
    result = select(x < broadcast(-87.3f), broadcast(0.0f), result);
    result = select(x > broadcast(88.72284f), broadcast(__builtin_inff()), result);
    return select(x == x, result, x);
}

// artanh(x) within 3e-7 relative to max(1, |artanh x|) for |x| <= 0.9999; other x are not allowed.
inline Float4 artanh(Float4 x) {
    // artanh(x) = ln(p / q) / 2 with p = 1 + x, q = 1 - x. With e the difference of their binary logarithms,
    // rounded, p' = p / 2^e is near q, and ln(p' / q) / 2 = artanh(s) with s = (p' - q) / (p' + q), |s| <
    // 0.24.
    Float4 p = 1.0f + x, q = 1.0f - x;
    Int4 p_bits = std::bit_cast<Int4>(p), q_bits = std::bit_cast<Int4>(q);
    Int4 e = (p_bits - q_bits + (1 << 22)) >> 23;
    Int4 scaled_bits = p_bits - (e << 23);
    Float4 scaled = std::bit_cast<Float4>(scaled_bits);
    Float4 s = (scaled - q) / (scaled + q);
    Float4 s2 = s * s;
    Float4 series = (((s2 * (1.0f / 9) + 1.0f / 7) * s2 + 0.2f) * s2 + 1.0f / 3) * s2 + 1.0f;
    return __builtin_convertvector(e, Float4) * 0.346573590f + s * series; // ln(2) / 2
}

} // namespace montelux
