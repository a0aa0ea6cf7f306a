// Bisection in sorted tables without branches: the search that every tabulated distribution shares.
#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>

namespace montelux {

// Largest i in [0, size) with table[i] <= value, or 0 where there is none; size >= 1. The halving runs a
// number of steps that depends on size alone, and its choice compiles to a conditional move.
template <typename Entry, typename Value>
constexpr std::size_t find_last_not_above(const Entry* table, std::size_t size, Value value) {
    const Entry* base = table;
    while (size > 1) {
        std::size_t half = size / 2;
        base = base[half] <= value ? base + half : base;
        size -= half;
    }
    return static_cast<std::size_t>(base - table);
}

// x, or the largest number below `end`: rounding must not carry a sample out of a half-open interval.
template <std::floating_point T>
T keep_below(T x, T end) {
    return x < end ? x : std::nextafter(end, std::numeric_limits<T>::lowest());
}

} // namespace montelux
