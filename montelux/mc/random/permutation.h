// Pseudo-random permutations of [0, n) with random access.
#pragma once

#include <bit>
#include <cstdint>

#include "montelux/mc/random/hash.h"

namespace montelux {

// Image of i < n under the permutation that `key` names: a keyed bijection on the next power of two, repeated
// until it lands below n (cycle walking; Kensler 2013, "Correlated Multi-Jittered Sampling", section 3). Its
// rounds are affine maps with keys of their own, and shifts that carry high bits down; over mixed keys the
// images of two elements are spread like those of a random permutation, which for small n Kensler's own
// rounds are not.
constexpr std::uint32_t permute(std::uint32_t i, std::uint32_t n, std::uint64_t key) {
    const int bits = n <= 1 ? 0 : std::bit_width(n - 1);
    const std::uint32_t mask = bits == 0 ? 0 : ~std::uint32_t{0} >> (32 - bits);
    const int half = (bits + 1) / 2;
    do {
        std::uint64_t h = key;
        for (int round = 0; round < 6; ++round) {
            i = (i * (static_cast<std::uint32_t>(h >> 3) | 1u) + static_cast<std::uint32_t>(h >> 32)) & mask;
            i ^= i >> half;
            h = (h ^ h >> 29) * golden_gamma;
        }
        i = (i + static_cast<std::uint32_t>(h >> 32)) & mask;
    } while (i >= n);
    return i;
}

} // namespace montelux
