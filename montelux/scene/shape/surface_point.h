// The point of a surface that a ray hit: position, normals, texture coordinates.
#pragma once

#include "montelux/mc/math/frame.h"
#include "montelux/scene/shape/ray.h"
#include "montelux/scene/view.h"

namespace montelux {

struct SurfacePoint {
    Point3f p;
    Normal3f ng;      // geometric normal, unit, on the side that ns is on
    Normal3f ns;      // shading normal, unit
    float error = 0;  // bound of the distance between p and the true surface along ng
    Point2f uv;       // these three by surface_point only when asked for
    Vec3f dpdu, dpdv; // with respect to uv
    const Shape* shape = nullptr;
    Index primitive = 0;
};

// Everything at a hit of `ray`. Texture coordinates and derivatives are computed only when asked for:
// textures and anisotropic BSDFs need them.
SurfacePoint surface_point(const SceneView& scene, const Ray& ray, const Hit& hit, bool coordinates);

// Of the vertices `v` of a triangle with vertex normals, at the weights b1 and b2 of the second and third
// one; not of unit length.
inline Vec3f interpolated_normal(const TriangleMesh& mesh, const Index* v, float b1, float b2) {
    const float b0 = 1 - b1 - b2;
    return b0 * mesh.normals[v[0]] + b1 * mesh.normals[v[1]] + b2 * mesh.normals[v[2]];
}
// Whether the geometric normal of the triangle is -n and not n there. This decides which side of an emitter
// shines, for hits and for light samples alike.
inline bool turns_normal(Vec3f interpolated, Normal3f n) {
    return length_squared(interpolated) > 0 && dot(interpolated, n) < 0;
}

// Bound of the rounding error of coordinates of that size, for offset_origin.
inline float coordinate_error(float largest) { return 0x1p-20f * largest; }
// The same along the normal n, where the coordinates differ in size: a floor at height 0 has next to none,
// however far it reaches. Never zero, for a ray must not begin on the surface.
inline float coordinate_error(Normal3f n, Vec3f largest) {
    return coordinate_error(dot(abs(n), largest) + 0x1p-40f * max_component(largest));
}

} // namespace montelux
