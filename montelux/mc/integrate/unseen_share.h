// What n points that all agree leave open: the share of a domain that none of them met.
#pragma once

#include <cstdint>

namespace montelux {

// Half of the 95 % bound 3 / n on the probability of an event that n independent points did not meet (the
// rule of three; Hanley & Lippman-Hand 1983, "If nothing goes wrong, is everything all right?"): one standard
// error, where two are the bound.
inline double unseen_share(std::uint64_t points) {
    return points == 0 ? 1 : 1.5 / static_cast<double>(points);
}

} // namespace montelux
