// SurfacePoint: a point on a surface with normals and texture coordinates.
#pragma once

#include "montelux/mc/math/frame.h"
#include "montelux/scene/shape/ray.h"
#include "montelux/scene/view.h"

namespace montelux {

struct SurfacePoint {
    Point3f p;
    Normal3f ng;                 // geometric normal, unit, on the side of ns
    Normal3f ns;                 // shading normal, unit
    float error = 0;             // bound of the distance between p and the true surface along ng
    Point2f uv;                  // this and the tangents are computed by surface_point only on request
    Vec3f dpdu, dpdv;            // with respect to uv
    Vec3f vertex_tangent{};      // interpolated; zero where the mesh has none
    Vec3f vertex_color{1, 1, 1}; // interpolated, as the two above; white where the mesh has none
    float vertex_opacity = 1;
    // Of the mesh's second set of texture coordinates, as uv, dpdu and dpdv; zero where it has none.
    Point2f second_uv{};
    Vec3f second_dpdu{}, second_dpdv{};
    const Shape* shape = nullptr;
    Index primitive = 0;
    Vec2f b{}; // Hit::b1 and b2

    // The first axis of the shading frame is its part across the shading normal.
    Vec3f tangent() const { return length_squared(vertex_tangent) > 0 ? vertex_tangent : dpdu; }
};

// The surface at a hit of `ray`. Texture coordinates and derivatives are computed on request: textures and
// anisotropic BSDFs need them.
SurfacePoint surface_point(const SceneView& scene, const Ray& ray, const Hit& hit, bool coordinates);

// The part of a SurfacePoint that needs no coordinates, of a number type.
template <Number T>
struct TrianglePoint {
    Vec3<T> p, ng, ns;
    T error;
};

// The interpolated vertex normal of a triangle with vertices `v`, at weights b1 and b2 of the second and
// third vertex; not of unit length.
inline Vec3f interpolated_normal(const TriangleMesh& mesh, const Index* v, float b1, float b2,
                                 float time = 0) {
    const float b0 = 1 - b1 - b2;
    return b0 * mesh.normal(v[0], time) + b1 * mesh.normal(v[1], time) + b2 * mesh.normal(v[2], time);
}
// Whether the triangle's geometric normal there is -n rather than n. Decides which side of an emitter emits,
// for hits and light samples alike.
inline bool turns_normal(Vec3f interpolated, Normal3f n) {
    return length_squared(interpolated) > 0 && dot(interpolated, n) < 0;
}

// The interpolated vertex normal of a patch, not of unit length; zero without vertex normals.
Vec3f interpolated_patch_normal(const BilinearMesh& mesh, std::size_t primitive, float u, float v);
// SurfacePoint::ng of a patch at u and v.
Normal3f patch_normal(const BilinearMesh& mesh, const Shape& shape, std::size_t primitive, double u,
                      double v);
// SurfacePoint::error of points of a patch.
float patch_error(const BilinearPatch& patch, Normal3f n);

// Bound on the rounding error of coordinates of that size, for offset_origin.
template <Number T>
T coordinate_error(T largest) {
    return 0x1p-20f * largest;
}
// The same along the normal n, for coordinates of different sizes: an infinite floor at height 0 has almost
// none. Never zero: a ray must not start on the surface.
template <Number T>
T coordinate_error(Vec3<T> n, Vec3<T> largest) {
    return coordinate_error(dot(abs(n), largest) + 0x1p-40f * max_component(largest));
}

// SurfacePoint::error of a point that the transformation has brought to `p`.
float transformed_error(float error, const Transform& t, Point3f p);

// A point of a triangle by the weights b1 and b2 of its second and third vertex. `flipped` as
// Shape::flip_normal. `vertex_normal` is the interpolated one, or zero.
template <Number T>
TrianglePoint<T> triangle_point(Vec3<T> p0, Vec3<T> p1, Vec3<T> p2, T b1, T b2, MaskOf<T> flipped,
                                Vec3<T> vertex_normal) {
    using std::sqrt;
    TrianglePoint<T> s;
    const T b0 = 1 - b1 - b2;
    s.p = b0 * p0 + b1 * p1 + b2 * p2;
    s.ng = normalize(cross(p1 - p0, p2 - p0));
    s.ng = select(flipped, -s.ng, s.ng);
    const T len2 = length_squared(vertex_normal);
    const MaskOf<T> smooth = len2 > 0;
    s.ns = select(smooth, vertex_normal / sqrt(len2), s.ng);
    s.ng = select(smooth & (dot(vertex_normal, s.ng) < 0), -s.ng, s.ng);
    s.error = coordinate_error(s.ng, max(abs(p0), max(abs(p1), abs(p2))));
    return s;
}

} // namespace montelux
