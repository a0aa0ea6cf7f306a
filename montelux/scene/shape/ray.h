// Rays and hits.
#pragma once

#include <cmath>
#include <limits>

#include "montelux/mc/math/vec.h"
#include "montelux/scene/index.h"

namespace montelux {

// Points o + t d for t in [0, t_max]; d need not be of unit length.
struct Ray {
    Point3f o;
    Vec3f d;
    float t_max = std::numeric_limits<float>::infinity();
    float time = 0; // of motions, in [0, 1]
};

struct Hit {
    float t = 0;
    float b1 = 0, b2 = 0; // barycentric weights of a triangle's second and third vertex; u and v of a patch
    Index shape = no_index;
    Index primitive = 0;
    Index instance = no_index; // into Scene::instances; no_index for shapes directly in the world
};

// The origin of a ray that leaves a surface: p offset along the unit normal, to the side of w, by `error`, a
// bound on the distance between p and the true surface. Scale-free: the bound is proportional to the
// coordinates.
template <Number T>
[[gnu::always_inline]] inline Vec3<T> offset_origin(Vec3<T> p, Vec3<T> n, T error, Vec3<T> w) {
    using std::copysign;
    return p + n * copysign(error, dot(n, w));
}

} // namespace montelux
