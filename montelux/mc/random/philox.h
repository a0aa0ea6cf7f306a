// Philox4x32: random numbers as a pure function of a counter and a key.
#pragma once

#include <array>
#include <cstdint>

#include "montelux/mc/math/number.h"

namespace montelux {

// Salmon, Moraes, Dror, Shaw 2011, "Parallel random numbers: as easy as 1, 2, 3", section 3.3. For each key a
// bijection of the 128-bit counters. Seven rounds are the fewest that pass BigCrush (their table 2); ten are
// what the authors recommend where a margin matters more than time.
// Bits: std::uint32_t, or LaneBits for many counters and keys at a time.
template <int Rounds = 7, typename Bits = std::uint32_t>
constexpr std::array<Bits, 4> philox4x32(std::array<Bits, 4> counter, std::array<Bits, 2> key) {
    for (int round = 0; round < Rounds; ++round) {
        const auto p0 = wide_product(counter[0], 0xd2511f53u);
        const auto p1 = wide_product(counter[2], 0xcd9e8d57u);
        counter = {p1.high ^ counter[1] ^ key[0], p1.low, p0.high ^ counter[3] ^ key[1], p0.low};
        key[0] = key[0] + 0x9e3779b9u; // golden ratio
        key[1] = key[1] + 0xbb67ae85u; // sqrt(3) - 1
    }
    return counter;
}

} // namespace montelux
