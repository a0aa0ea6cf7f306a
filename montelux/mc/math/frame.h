// Orthonormal frames: local directions have the normal along +z.
#pragma once

#include "montelux/mc/math/vec.h"

namespace montelux {

// s, t, n are orthonormal and right-handed (s x t = n). Functions are always inlined: large callers exceed
// the compiler's limits, and passing vectors through memory costs more than the operations.
struct Frame {
    Vec3f s{1, 0, 0}, t{0, 1, 0}, n{0, 0, 1};

    // Any frame around the unit vector n. Duff et al. 2017, "Building an Orthonormal Basis,
    // Revisited", JCGT 6(1), listing 3.
    [[gnu::always_inline]] static Frame from_normal(Vec3f n) {
        float sign = std::copysign(1.0f, n.z);
        float a = -1.0f / (sign + n.z);
        float b = n.x * n.y * a;
        return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
    }

    // The frame around the unit vector n whose s is the part of `tangent` orthogonal to n;
    // falls back to any frame where the two are parallel.
    [[gnu::always_inline]] static Frame from_normal_and_tangent(Vec3f n, Vec3f tangent) {
        Vec3f s = tangent - n * dot(n, tangent);
        float len2 = length_squared(s);
        if (!(len2 > 1e-12f * length_squared(tangent))) return from_normal(n);
        s = s / std::sqrt(len2);
        return {s, cross(n, s), n};
    }

    [[gnu::always_inline]] Vec3f to_local(Vec3f v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
    [[gnu::always_inline]] Vec3f to_world(Vec3f v) const { return s * v.x + t * v.y + n * v.z; }
};

} // namespace montelux
