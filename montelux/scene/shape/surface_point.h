// SurfacePoint: a point on a surface with normals and texture coordinates.
#pragma once

#include "montelux/mc/math/frame.h"
#include "montelux/scene/shape/ray.h"
#include "montelux/scene/view.h"

namespace montelux {

struct SurfacePoint {
    Point3f p;
    Normal3f ng;      // geometric normal, unit, on the side of ns
    Normal3f ns;      // shading normal, unit
    float error = 0;  // bound of the distance between p and the true surface along ng
    Point2f uv;       // this and the tangents are computed by surface_point only on request
    Vec3f dpdu, dpdv; // with respect to uv
    const Shape* shape = nullptr;
    Index primitive = 0;
};

// The surface at a hit of `ray`. Texture coordinates and derivatives are computed on request: textures and
// anisotropic BSDFs need them.
SurfacePoint surface_point(const SceneView& scene, const Ray& ray, const Hit& hit, bool coordinates);

// The interpolated vertex normal of a triangle with vertices `v`, at weights b1 and b2 of the second and
// third vertex; not of unit length.
inline Vec3f interpolated_normal(const TriangleMesh& mesh, const Index* v, float b1, float b2) {
    const float b0 = 1 - b1 - b2;
    return b0 * mesh.normals[v[0]] + b1 * mesh.normals[v[1]] + b2 * mesh.normals[v[2]];
}
// Whether the triangle's geometric normal there is -n rather than n. Decides which side of an emitter emits,
// for hits and light samples alike.
inline bool turns_normal(Vec3f interpolated, Normal3f n) {
    return length_squared(interpolated) > 0 && dot(interpolated, n) < 0;
}

// Bound on the rounding error of coordinates of that size, for offset_origin.
inline float coordinate_error(float largest) { return 0x1p-20f * largest; }
// The same along the normal n, for coordinates of different sizes: an infinite floor at height 0 has almost
// none. Never zero: a ray must not start on the surface.
inline float coordinate_error(Normal3f n, Vec3f largest) {
    return coordinate_error(dot(abs(n), largest) + 0x1p-40f * max_component(largest));
}

} // namespace montelux
