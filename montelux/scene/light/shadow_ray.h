// Rays from a reference point to a light.
#pragma once

#include "montelux/scene/light/light_model.h"

namespace montelux {

// From an offset origin at the reference to just before the point on the light, even if that point is exact.
inline Ray shadow_ray(const ReferencePoint& from, Vec3f wi, Point3f to, Normal3f n, float error) {
    Point3f o = offset_origin(from.p, from.n, from.error, wi);
    Point3f end = offset_origin(to, n, error, -wi);
    return {o, end - o, 1 - 0x1p-18f};
}

inline Ray shadow_ray_to_infinity(const ReferencePoint& from, Vec3f wi) {
    return {offset_origin(from.p, from.n, from.error, wi), wi};
}

} // namespace montelux
