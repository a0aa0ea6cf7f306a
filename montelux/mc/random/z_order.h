// Pixels along a randomised Z curve: the order that gives Monte Carlo errors a blue-noise spectrum.
#pragma once

#include <array>
#include <cstdint>

#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/uniform_bits.h"

namespace montelux {

// Interleaves the low 16 bits of x (even places) and y (odd places).
constexpr std::uint32_t morton_code(std::uint32_t x, std::uint32_t y) {
    const auto spread = [](std::uint32_t v) {
        v &= 0xffffu;
        v = (v | v << 8) & 0x00ff00ffu;
        v = (v | v << 4) & 0x0f0f0f0fu;
        v = (v | v << 2) & 0x33333333u;
        return (v | v << 1) & 0x55555555u;
    };
    return spread(x) | spread(y) << 1;
}

// The 24 permutations of {0, 1, 2, 3}; digit d goes to bits 2d, 2d + 1 of an entry.
inline constexpr std::array<std::uint8_t, 24> quad_permutations = [] {
    std::array<std::uint8_t, 24> table{};
    int n = 0;
    for (unsigned a = 0; a < 4; ++a)
        for (unsigned b = 0; b < 4; ++b)
            for (unsigned c = 0; c < 4; ++c)
                if (a != b && a != c && b != c)
                    table[n++] = static_cast<std::uint8_t>(a | b << 2 | c << 4 | (6 - a - b - c) << 6);
    return table;
}();

// Permutes the base-4 digits of `index` (of `bits` binary digits; a single one is left at the bottom if odd),
// each as the digits above it and the key decide. Neighbours along the Z curve stay neighbours, so the points
// of any block of 2^k x 2^k pixels are together a net. Ahmed, Wonka 2020, "Screen-Space Blue-Noise Diffusion
// of Monte Carlo Sampling Error via Hierarchical Ordering of Pixels", section 4.
constexpr std::uint64_t shuffle_quads(std::uint64_t index, int bits, std::uint64_t key) {
    std::uint64_t shuffled = 0;
    int shift = bits;
    while (shift >= 2) {
        shift -= 2;
        // The sentinel bit distinguishes equal prefixes of different lengths.
        std::uint64_t h =
            ((index >> (shift + 2) | std::uint64_t{1} << (bits - shift - 2)) ^ key) * golden_gamma;
        h = (h ^ h >> 32) * 0xbf58476d1ce4e5b9u;
        const std::uint32_t choice = bounded(static_cast<std::uint32_t>(h >> 32), 24);
        const std::uint64_t digit = index >> shift & 3u;
        shuffled = shuffled << 2 | (quad_permutations[choice] >> (2 * digit) & 3u);
    }
    if (shift == 1) shuffled = shuffled << 1 | ((index ^ mix64(key ^ index >> 1)) & 1u);
    return shuffled;
}

} // namespace montelux
