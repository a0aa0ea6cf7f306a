// Functions of lanes for which the compiler's vector types have no operator: they take the processor's intrinsics.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#ifdef __AVX2__
#include <immintrin.h>
#endif

#include "montelux/mc/math/lanes.h"

namespace montelux {

// Whether the condition holds in some lane, in every lane.
template <int W>
bool any(LaneMask<W> m) {
#ifdef __AVX2__
    if constexpr (W == 8) return _mm256_movemask_ps(std::bit_cast<__m256>(m.v)) != 0;
#endif
#ifdef __AVX512DQ__
    if constexpr (W == 16) return _mm512_movepi32_mask(std::bit_cast<__m512i>(m.v)) != 0;
#endif
    std::int32_t some = 0;
    for (int i = 0; i < W; ++i) some |= m.v[i];
    return some != 0;
}
template <int W>
bool all(LaneMask<W> m) {
    return !any(!m);
}

template <int W>
Lanes<W> sqrt(Lanes<W> a) {
#ifdef __AVX2__
    if constexpr (W == 8)
        return Lanes<W>(std::bit_cast<typename Lanes<W>::Vector>(_mm256_sqrt_ps(std::bit_cast<__m256>(a.v))));
#endif
#ifdef __AVX512F__
    if constexpr (W == 16)
        return Lanes<W>(std::bit_cast<typename Lanes<W>::Vector>(_mm512_sqrt_ps(std::bit_cast<__m512>(a.v))));
#endif
    return Lanes<W>::from([&](int i) { return std::sqrt(a.v[i]); });
}

template <int W>
WideProduct<LaneBits<W>> wide_product(LaneBits<W> a, std::uint32_t b) {
#ifdef __AVX2__
    if constexpr (W == 8) {
        const auto v = std::bit_cast<__m256i>(a.v), factor = _mm256_set1_epi32(static_cast<int>(b));
        const __m256i even = _mm256_mul_epu32(v, factor);
        const __m256i odd = _mm256_mul_epu32(_mm256_srli_epi64(v, 32), factor);
        const __m256i high = _mm256_blend_epi32(_mm256_srli_epi64(even, 32), odd, 0xaa);
        const __m256i low = _mm256_blend_epi32(even, _mm256_slli_epi64(odd, 32), 0xaa);
        using Vector = typename LaneBits<W>::Vector;
        return {LaneBits<W>(std::bit_cast<Vector>(high)), LaneBits<W>(std::bit_cast<Vector>(low))};
    }
#endif
    WideProduct<LaneBits<W>> p;
    for (int i = 0; i < W; ++i) {
        const auto [high, low] = wide_product(a.v[i], b);
        p.high.v[i] = high;
        p.low.v[i] = low;
    }
    return p;
}

// table[index] of each lane.
template <int W>
Lanes<W> gather(const float* table, LaneBits<W> index) {
#ifdef __AVX2__
    if constexpr (W == 8)
        return Lanes<W>(std::bit_cast<typename Lanes<W>::Vector>(
            _mm256_i32gather_ps(table, std::bit_cast<__m256i>(index.v), 4)));
#endif
#ifdef __AVX512F__
    if constexpr (W == 16)
        return Lanes<W>(std::bit_cast<typename Lanes<W>::Vector>(
            _mm512_i32gather_ps(std::bit_cast<__m512i>(index.v), table, 4)));
#endif
    return Lanes<W>::from([&](int i) { return table[index.v[i]]; });
}

} // namespace montelux
