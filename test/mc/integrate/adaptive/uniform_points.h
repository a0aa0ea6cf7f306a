// Uniform points to learn a density from.
#pragma once

#include <cstdint>

#include "montelux/mc/integrate/points.h"
#include "montelux/mc/stats/chi_squared.h"

namespace montelux {

inline PointBuffer uniform_points(std::size_t count, int dimensions, std::uint64_t seed) {
    PointBuffer points(count, dimensions);
    TestUniforms uniforms(seed);
    for (std::size_t i = 0; i < count; ++i)
        for (int d = 0; d < dimensions; ++d) points(i, d) = uniforms.next();
    return points;
}

} // namespace montelux
