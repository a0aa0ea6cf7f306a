// Importance: an estimate of the light that a point receives from a group of lights, from their bounds.
#pragma once

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/vec.h"

namespace montelux {

// What is known of lights that are chosen together. Lengths are in units of the tree.
template <Number T>
struct LightGroup {
    Vec3<T> center; // of a sphere around them
    T radius = 1;   // above 0
    Vec3<T> axis;   // of their LightCone
    T cos_theta_o = -1, sin_theta_o = 0, cos_theta_e = -1;
    T two_sided = 0; // 1 if the cone has two sides
    T intensity = 0; // flux over the cone's measure; 0 in unused lanes
};

// The point that is lit.
struct LitPoint {
    Point3f p;      // in units of the tree
    Vec3f facing{}; // ReferencePoint::facing
};

// cos(max(0, a - b)) from cosines and sines of two angles in [0, pi].
template <Number T>
T cos_of_excess(T cos_a, T sin_a, T cos_b, T sin_b) {
    return select(cos_a >= cos_b, T(1), cos_a * cos_b + sin_a * sin_b);
}

// Conty Estevez and Kulla 2018, equation 3, with the bounds of angles of Pharr, Jakob and Humphreys 2023,
// section 12.6.3: intensity over squared distance, times a bound on the cosine at the lights and one on the
// cosine at the point. It is 0 only if no light of the group reaches the point on the side that it faces:
// close to the horizons, where rounding decides, it is small. The sphere stands for the box, so distances below
// its radius count as the radius.
template <Number T>
T light_importance(const LightGroup<T>& group, const LitPoint& at) {
    using std::abs;
    using std::max;
    using std::min;
    using std::sqrt;
    constexpr float slack = 1e-4f, least = 0.01f;
    const auto sine = [](T cosine) { return sqrt(max(T(0), T(1) - cosine * cosine)); };
    const auto above = [&](T cosine, T horizon) {
        return select(cosine > horizon - T(slack), max(cosine, T(least)), T(0));
    };

    const Vec3<T> to_group = group.center - Vec3<T>(T(at.p.x), T(at.p.y), T(at.p.z));
    const T d2 = dot(to_group, to_group), r2 = group.radius * group.radius;
    const auto inside = d2 <= r2;
    const T inverse = T(1) / sqrt(max(d2, r2));
    // Half of the angle that the sphere subtends.
    const T sin_b = group.radius * inverse, cos_b = sine(sin_b);

    T cos_w = -dot(group.axis, to_group) * inverse;
    cos_w = select(group.two_sided > T(0), abs(cos_w), cos_w);
    const T sin_w = sine(cos_w);
    const auto within = cos_w >= group.cos_theta_o;
    const T cos_x = select(within, T(1), cos_w * group.cos_theta_o + sin_w * group.sin_theta_o);
    const T sin_x = select(within, T(0), sin_w * group.cos_theta_o - cos_w * group.sin_theta_o);
    const T cos_light = select(inside, T(1), cos_of_excess(cos_x, sin_x, cos_b, sin_b));

    T importance = group.intensity * (inverse * inverse) * above(cos_light, group.cos_theta_e);
    if (!(at.facing == Vec3f{})) {
        const T cos_i = dot(Vec3<T>(T(at.facing.x), T(at.facing.y), T(at.facing.z)), to_group) * inverse;
        const T cos_point = select(inside, T(1), cos_of_excess(cos_i, sine(cos_i), cos_b, sin_b));
        importance = importance * above(cos_point, T(0));
    }
    return importance;
}

} // namespace montelux
