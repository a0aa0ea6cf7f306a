// Orthonormal frames: local directions have the normal along +z.
#pragma once

#include "montelux/mc/math/vec.h"

namespace montelux {

// s, t, n are orthonormal and right-handed (s x t = n). Functions are always inlined: large callers exceed
// the compiler's limits, and passing vectors through memory costs more than the operations.
template <Number T>
struct FrameOf {
    Vec3<T> s{1, 0, 0}, t{0, 1, 0}, n{0, 0, 1};

    // Any frame around the unit vector n. Duff et al. 2017, "Building an Orthonormal Basis,
    // Revisited", JCGT 6(1), listing 3.
    [[gnu::always_inline]] static FrameOf from_normal(Vec3<T> n) {
        using std::copysign;
        const T sign = copysign(T(1), n.z);
        const T a = T(-1) / (sign + n.z);
        const T b = n.x * n.y * a;
        return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
    }

    // The frame around the unit vector n whose s is the part of `tangent` orthogonal to n;
    // falls back to any frame where the two are parallel.
    [[gnu::always_inline]] static FrameOf from_normal_and_tangent(Vec3<T> n, Vec3<T> tangent) {
        using std::sqrt;
        const Vec3<T> across = tangent - n * dot(n, tangent);
        const T len2 = length_squared(across);
        const MaskOf<T> parallel = !(len2 > 1e-12f * length_squared(tangent));
        const Vec3<T> s = across / sqrt(len2);
        const FrameOf along{s, cross(n, s), n};
        return any(parallel) ? select(parallel, from_normal(n), along) : along;
    }

    [[gnu::always_inline]] Vec3<T> to_local(Vec3<T> v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
    [[gnu::always_inline]] Vec3<T> to_world(Vec3<T> v) const { return s * v.x + t * v.y + n * v.z; }

    [[gnu::always_inline]] friend FrameOf select(MaskOf<T> condition, FrameOf a,
                                                 FrameOf b) requires LaneNumber<T> {
        return {select(condition, a.s, b.s), select(condition, a.t, b.t), select(condition, a.n, b.n)};
    }
};
using Frame = FrameOf<float>;

} // namespace montelux
