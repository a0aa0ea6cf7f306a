// Random bits to uniform numbers in [0, 1).
#pragma once

#include <cstdint>

namespace montelux {

// Multiples of 2^-24 and of 2^-53: every value below 1 is exact, so nothing rounds up to 1.
constexpr float unit_float(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }
constexpr double unit_double(std::uint32_t bits) { return bits * 0x1p-32; }
constexpr double unit_double(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

// Uniform integer in [0, n) from 32 random bits; a value's probability is off by at most 2^-32.
constexpr std::uint32_t bounded(std::uint32_t bits, std::uint32_t n) {
    return static_cast<std::uint32_t>((std::uint64_t{bits} * n) >> 32);
}

} // namespace montelux
