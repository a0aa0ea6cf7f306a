// Philox4x32: random numbers as a pure function of a counter and a key.
#pragma once

#include <array>
#include <cstdint>

namespace montelux {

// Salmon, Moraes, Dror, Shaw 2011, "Parallel random numbers: as easy as 1, 2, 3", section 3.3. For each key a
// bijection of the 128-bit counters. Seven rounds are the fewest that pass BigCrush (their table 2); ten are
// what the authors recommend where a margin matters more than time.
template <int Rounds = 7>
constexpr std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                                  std::array<std::uint32_t, 2> key) {
    for (int round = 0; round < Rounds; ++round) {
        const std::uint64_t p0 = std::uint64_t{0xd2511f53u} * counter[0];
        const std::uint64_t p1 = std::uint64_t{0xcd9e8d57u} * counter[2];
        counter = {static_cast<std::uint32_t>(p1 >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(p1),
                   static_cast<std::uint32_t>(p0 >> 32) ^ counter[3] ^ key[1],
                   static_cast<std::uint32_t>(p0)};
        key[0] += 0x9e3779b9u; // golden ratio
        key[1] += 0xbb67ae85u; // sqrt(3) - 1
    }
    return counter;
}

} // namespace montelux
