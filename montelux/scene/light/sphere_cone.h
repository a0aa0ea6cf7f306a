// SphereCone: the cone of directions from a point outside a sphere to the sphere.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "montelux/mc/math/constants.h"
#include "montelux/scene/shape/quadric.h"

namespace montelux {

// Uniform over its solid angle.
struct SphereCone {
    Vec3f axis;
    double distance;
    double sin2_max;

    // Empty inside the sphere, and so close to it that the cone is almost a hemisphere.
    static std::optional<SphereCone> seen_from(Point3f from, const WorldSphere& sphere) {
        Vec3d axis = sphere.center - Vec3d(from);
        double d2 = dot(axis, axis), r2 = sphere.radius * sphere.radius;
        if (d2 <= r2 * 1.0001) return std::nullopt;
        double d = std::sqrt(d2);
        return SphereCone{Vec3f(axis / d), d, r2 / d2};
    }
    // 1 - cos(theta_max) without cancellation.
    double one_minus_cos_max() const { return sin2_max / (1 + std::sqrt(std::max(0.0, 1 - sin2_max))); }
    float pdf() const { return static_cast<float>(inv_two_pi / one_minus_cos_max()); }
};

} // namespace montelux
