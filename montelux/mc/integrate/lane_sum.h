// Sums over arrays in a fixed order that vectorises.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace montelux {

// term(0) + ... + term(n - 1), in eight interleaved partial sums.
template <typename Term>
double lane_sum(std::size_t n, const Term& term) {
    constexpr std::size_t lanes = 8;
    std::array<double, lanes> sums{};
    std::size_t i = 0;
    for (; i + lanes <= n; i += lanes)
        for (std::size_t l = 0; l < lanes; ++l) sums[l] += term(i + l);
    for (; i < n; ++i) sums[i % lanes] += term(i);
    return ((sums[0] + sums[4]) + (sums[1] + sums[5])) + ((sums[2] + sums[6]) + (sums[3] + sums[7]));
}

// The largest term, and at least 0.
template <typename Term>
double lane_max(std::size_t n, const Term& term) {
    constexpr std::size_t lanes = 8;
    std::array<double, lanes> most{};
    std::size_t i = 0;
    for (; i + lanes <= n; i += lanes)
        for (std::size_t l = 0; l < lanes; ++l) most[l] = std::max(most[l], term(i + l));
    for (; i < n; ++i) most[0] = std::max(most[0], term(i));
    return *std::max_element(most.begin(), most.end());
}

} // namespace montelux
