// Weyl (Kronecker) sequences of the square roots of the primes.
#pragma once

#include <cmath>
#include <cstdint>

#include "montelux/mc/random/prime_base.h"
#include "montelux/mc/random/uniform_bits.h"

namespace montelux {

// Fractional part of the square root of the prime of this dimension, in [0, 1024), as a fraction of 2^64.
inline std::uint64_t weyl_step(int dimension) {
    const long double root = std::sqrt(static_cast<long double>(prime_bases[dimension].base));
    return static_cast<std::uint64_t>((root - std::floor(root)) * 0x1p64L);
}

// Coordinate of point i: the fractional part of i step (Weyl 1916, "Ueber die Gleichverteilung von Zahlen
// mod. Eins"). The first point is the origin.
constexpr double weyl_coordinate(std::uint64_t i, std::uint64_t step) { return unit_double(i * step); }

} // namespace montelux
