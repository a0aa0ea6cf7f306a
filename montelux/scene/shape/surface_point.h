// The point of a surface that a ray hit: position, normals, texture coordinates.
#pragma once

#include "montelux/mc/math/frame.h"
#include "montelux/scene/scene.h"
#include "montelux/scene/shape/ray.h"

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
SurfacePoint surface_point(const Scene& scene, const Ray& ray, const Hit& hit, bool coordinates);

// Bound of the rounding error of coordinates of that size, for offset_origin.
inline float coordinate_error(float largest) { return 0x1p-20f * largest; }
// The same along the normal n, where the coordinates differ in size: a floor at height 0 has next to none,
// however far it reaches. Never zero, for a ray must not begin on the surface.
inline float coordinate_error(Normal3f n, Vec3f largest) {
    return coordinate_error(dot(abs(n), largest) + 0x1p-40f * max_component(largest));
}

} // namespace montelux
