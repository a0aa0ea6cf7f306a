// Shared checks of the random room's tests: uniform cells and elementary intervals.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/math/vec.h"
#include "montelux/mc/stats/chi_squared.h"

namespace montelux::testing {

// p-value of the hypothesis that the points are independent and uniform on the unit square.
inline double uniform_square_p_value(std::span<const Vec2d> points, int cells_x, int cells_y) {
    std::vector<double> observed(static_cast<std::size_t>(cells_x) * cells_y, 0.0);
    for (const Vec2d& p : points) {
        if (!(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1)) return 0;
        ++observed[static_cast<int>(p.y * cells_y) * cells_x + static_cast<int>(p.x * cells_x)];
    }
    const std::vector<double> expected(observed.size(), static_cast<double>(points.size()) / observed.size());
    return chi_squared_test(observed, expected).p_value;
}

// Do all elementary intervals of b^-j x b^-(m - t - j) hold b^t of these b^m points? Then they are a
// (t,m,2)-net.
inline bool is_net(std::span<const Vec2d> points, int t, std::uint32_t base = 2) {
    int m = 0;
    for (std::size_t n = 1; n < points.size(); n *= base) ++m;
    std::uint64_t each = 1;
    for (int k = 0; k < t; ++k) each *= base;
    for (int j = 0; j <= m - t; ++j) {
        std::uint64_t nx = 1, ny = 1;
        for (int k = 0; k < j; ++k) nx *= base;
        for (int k = 0; k < m - t - j; ++k) ny *= base;
        std::vector<std::uint64_t> counts(nx * ny, 0);
        for (const Vec2d& p : points)
            ++counts[static_cast<std::uint64_t>(p.y * ny) * nx + static_cast<std::uint64_t>(p.x * nx)];
        for (std::uint64_t c : counts)
            if (c != each) return false;
    }
    return true;
}

} // namespace montelux::testing
