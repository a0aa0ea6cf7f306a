// Axis-aligned boxes in world space.
#pragma once

#include "montelux/mc/math/vec.h"

namespace montelux {

struct Bounds3 {
    Vec3d lower{1e300, 1e300, 1e300}, upper{-1e300, -1e300, -1e300};

    void add(Vec3d p) {
        lower = min(lower, p);
        upper = max(upper, p);
    }
    bool empty() const { return !(lower.x <= upper.x); }
    // Corner i, from 0 to 7.
    Vec3d corner(int i) const {
        return {(i & 1) != 0 ? upper.x : lower.x, (i & 2) != 0 ? upper.y : lower.y,
                (i & 4) != 0 ? upper.z : lower.z};
    }
    Vec3d center() const { return 0.5 * (lower + upper); }
    double radius() const { return empty() ? 0 : 0.5 * length(upper - lower); }
};

} // namespace montelux
