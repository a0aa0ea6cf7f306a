// Numbers of Sobol' points that divide the cube evenly: 2^k and 3 * 2^(k - 1).
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace montelux {

// The next one above n.
inline std::uint64_t next_balanced(std::uint64_t n) {
    const std::uint64_t floor = std::bit_floor(n);
    return n < floor + floor / 2 ? floor + floor / 2 : 2 * floor;
}

// The largest one that is at most n.
inline std::uint64_t last_balanced(std::uint64_t n) {
    const std::uint64_t floor = std::bit_floor(n);
    return n >= floor + floor / 2 ? floor + floor / 2 : floor;
}

} // namespace montelux
