// The first coordinate of Hammersley sets: equal steps, plain and randomised.
#pragma once

#include <cstdint>

#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/uniform_bits.h"

namespace montelux {

// Hammersley 1960, "Monte Carlo methods for solving multivariable problems": i / n.
constexpr double equidistant(std::uint32_t i, std::uint32_t n) { return i / static_cast<double>(n); }

// One point in each of n equal cells: the cells are turned by a random number of places, common to the set,
// and every point is jittered within its own. Uniform over keys for every i < n.
constexpr double turned_equidistant(std::uint32_t i, std::uint32_t n, std::uint64_t key) {
    const std::uint64_t turned = std::uint64_t{i} + bounded(static_cast<std::uint32_t>(key >> 32), n);
    const std::uint64_t cell = turned >= n ? turned - n : turned;
    const double jitter = unit_double(mix64(key ^ (i + 1) * golden_gamma));
    return (static_cast<double>(cell) + jitter) / n;
}

} // namespace montelux
