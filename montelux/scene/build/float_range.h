// Checks that positions and transformations fit into single precision, in which scenes are rendered.
#pragma once

#include <cmath>
#include <limits>

#include "montelux/mc/math/transform.h"
#include "montelux/scene/shape/quadric.h"

namespace montelux {

inline bool fits_float(Vec3d p) {
    constexpr double most = std::numeric_limits<float>::max();
    return std::abs(p.x) <= most && std::abs(p.y) <= most && std::abs(p.z) <= most;
}
inline bool fits_float(const Bounds3& bounds) { return fits_float(bounds.lower) && fits_float(bounds.upper); }

// The matrix and its inverse, in their first `columns` columns.
inline bool fits_float(const Transform& t, double most = std::numeric_limits<float>::max(),
                       std::size_t columns = 4) {
    for (const Matrix4* matrix : {&t.matrix(), &t.inverse_matrix()})
        for (const auto& row : matrix->m)
            for (std::size_t i = 0; i < columns; ++i)
                if (!(std::abs(row[i]) <= most)) return false;
    return true;
}
// For directions, whose lengths are computed: their squares must fit, too. Ignores the translation.
inline bool turns_in_floats(const Transform& t) { return fits_float(t, 1e18, 3); }

} // namespace montelux
