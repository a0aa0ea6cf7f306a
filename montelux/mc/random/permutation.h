// Pseudo-random permutations of [0, n) with random access.
#pragma once

#include <bit>
#include <cstdint>

namespace montelux {

// Image of i < n under the permutation that `seed` names. Kensler 2013, "Correlated Multi-Jittered Sampling",
// section 3: an invertible hash on the next power of two, repeated until it lands below n (cycle walking).
constexpr std::uint32_t permute(std::uint32_t i, std::uint32_t n, std::uint32_t seed) {
    const std::uint32_t mask = n <= 1 ? 0 : ~std::uint32_t{0} >> std::countl_zero(n - 1);
    do {
        i ^= seed;
        i *= 0xe170893du;
        i ^= seed >> 16;
        i ^= (i & mask) >> 4;
        i ^= seed >> 8;
        i *= 0x0929eb3fu;
        i ^= seed >> 23;
        i ^= (i & mask) >> 1;
        i *= 1 | seed >> 27;
        i *= 0x6935fa69u;
        i ^= (i & mask) >> 11;
        i *= 0x74dcb303u;
        i ^= (i & mask) >> 2;
        i *= 0x9e501cc3u;
        i ^= (i & mask) >> 2;
        i *= 0xc860a3dfu;
        i &= mask;
        i ^= i >> 5;
    } while (i >= n);
    // The rotation makes the image of every i uniform over well mixed seeds.
    const std::uint32_t rotated = static_cast<std::uint32_t>((std::uint64_t{i} + seed) % n);
    return rotated;
}

} // namespace montelux
