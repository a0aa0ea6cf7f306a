// Jittered strata with random access: one number or a pair for sample i of n.
#pragma once

#include <cmath>
#include <cstdint>

#include "montelux/mc/math/vec.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/permutation.h"
#include "montelux/mc/random/uniform_bits.h"

namespace montelux {

// One point in each of n equal intervals, in random order (i < n). Keys give independent sets.
constexpr double stratified_1d(std::uint32_t i, std::uint32_t n, std::uint64_t key) {
    const std::uint32_t stratum = permute(i, n, key);
    const double jitter = unit_double(mix64(key ^ (i + 1) * golden_gamma));
    return (stratum + jitter) / n;
}

// The most nearly square grid of columns x rows >= n cells.
struct StrataGrid {
    std::uint32_t columns = 1, rows = 1;

    StrataGrid() = default;
    explicit StrataGrid(std::uint32_t n) {
        columns = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(n)));
        if (columns == 0) columns = 1;
        rows = (n + columns - 1) / columns;
    }
};

// Kensler 2013, "Correlated Multi-Jittered Sampling", listing 2, with independent permutations of rows and
// columns: one point in each cell of the grid and in each of n rows, and, if n = columns * rows, of n
// columns. Uniform on the unit square over keys for every i < n.
constexpr Vec2d multi_jittered_2d(std::uint32_t i, std::uint32_t n, const StrataGrid& grid,
                                  std::uint64_t key) {
    const std::uint64_t order = mix64(key), columns = mix64(key + golden_gamma),
                        rows = mix64(key - golden_gamma);
    const std::uint32_t s = permute(i, n, order);
    const std::uint32_t row = s / grid.columns;
    const std::uint32_t sx = permute(s - row * grid.columns, grid.columns, columns);
    const std::uint32_t sy = permute(row, grid.rows, rows);
    const std::uint64_t jitter = mix64(order ^ (i + 1) * golden_gamma);
    const double jx = unit_double(static_cast<std::uint32_t>(jitter));
    const double jy = unit_double(static_cast<std::uint32_t>(jitter >> 32));
    return {(sx + (sy + jx) / grid.rows) / grid.columns, (s + jy) / n};
}

} // namespace montelux
