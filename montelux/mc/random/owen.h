// Owen scrambling in base 2, of coordinates and of indices, by hashing.
#pragma once

#include <cstdint>

namespace montelux {

constexpr std::uint32_t reverse_bits(std::uint32_t x) {
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    return __builtin_bswap32(x);
}
constexpr std::uint64_t reverse_bits(std::uint64_t x) {
    x = ((x >> 1) & 0x5555555555555555u) | ((x & 0x5555555555555555u) << 1);
    x = ((x >> 2) & 0x3333333333333333u) | ((x & 0x3333333333333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0f0f0f0f0fu) | ((x & 0x0f0f0f0f0f0f0f0fu) << 4);
    return __builtin_bswap64(x);
}

// Bijection in which a bit is flipped or not according to the bits below it and the seed: an Owen scramble of
// a number whose bits are reversed. Construction: Laine, Karras 2011, "Stratified Sampling for Stochastic
// Transparency"; constants: Vegdahl 2021, "Building a Better LK Hash". The seed must be well mixed.
constexpr std::uint32_t owen_scramble_reversed(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// Scramble of a binary fraction x / 2^32 (Owen 1995, "Randomly permuted (t,m,s)-nets and (t,s)-sequences"):
// uniform over seeds, and two numbers that share their first k bits and no more still do.
constexpr std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
    return reverse_bits(owen_scramble_reversed(reverse_bits(x), seed));
}

} // namespace montelux
