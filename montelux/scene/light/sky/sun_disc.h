// SunDisc: the visible sun, a disc at infinity.
#pragma once

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/frame.h"
#include "montelux/mc/warp/cone.h"

namespace montelux {

// Angular radius of the sun from the earth, radians.
inline constexpr double sun_angular_radius = 0.2666 * pi / 180;

// Part of a small disc above a horizon; its centre is `above` over it, its radius is `radius` (both radians).
inline double part_above_horizon(double above, double radius) {
    const double x = above / radius;
    if (x >= 1) return 1;
    if (x <= -1) return 0;
    return 0.5 + (x * std::sqrt(1 - x * x) + std::asin(x)) / pi;
}

// Integral of the height over the horizon (radians) over that part, divided by the area of the whole disc.
inline double height_above_horizon(double above, double radius) {
    const double x = above / radius;
    if (x >= 1) return above;
    if (x <= -1) return 0;
    const double y2 = 1 - x * x;
    return above * part_above_horizon(above, radius) + radius * 2 / (3 * pi) * y2 * std::sqrt(y2);
}

// Directions within an angle of its centre, uniform in solid angle.
struct SunDisc {
    Vec3f centre{0, 0, 1}; // unit
    float versine = 0;     // 1 - cos(angle)

    static SunDisc of_radius(Vec3f centre, double radius) {
        const double s = std::sin(radius);
        return {centre, static_cast<float>(versine_from_sin_squared(s * s))};
    }
    // |w - centre|^2 = 2 (1 - cos), without the cancellation of the cosine.
    bool contains(Vec3f w) const { return length_squared(w - centre) < 2 * versine; }
    double solid_angle() const { return 2 * pi * static_cast<double>(versine); }
    float pdf() const { return uniform_cone_pdf_from_versine(versine); }
    Vec3f sample(Vec2f u) const {
        return normalize(Frame::from_normal(centre).to_world(sample_uniform_cone_from_versine(u, versine)));
    }
};

} // namespace montelux
