// AlbedoTable: an albedo by direction and roughness on a grid, interpolated linearly.
#pragma once

#include <algorithm>
#include <cstddef>

namespace montelux {

struct AlbedoTable {
    static constexpr std::size_t size = 16;
    float values[size][size]; // [row][column]

    // Of the position in the table, 0 to 1 along both axes.
    float at(float row, float column) const {
        const float last = static_cast<float>(size - 1);
        const float y = std::clamp(row, 0.0f, 1.0f) * last, x = std::clamp(column, 0.0f, 1.0f) * last;
        const std::size_t j = std::min(static_cast<std::size_t>(y), size - 2);
        const std::size_t i = std::min(static_cast<std::size_t>(x), size - 2);
        const float v = y - static_cast<float>(j), u = x - static_cast<float>(i);
        const auto along = [&](const float* r) { return (1 - u) * r[i] + u * r[i + 1]; };
        return (1 - v) * along(values[j]) + v * along(values[j + 1]);
    }
};

} // namespace montelux
