// Points of emissive shapes: triangles, discs, spheres and other quadrics.
#pragma once

#include <optional>

#include "montelux/scene/light/light_context.h"
#include "montelux/scene/shape/surface_point.h"

namespace montelux {

// A point on an emissive shape.
struct EmissivePoint {
    Hit hit; // barycentric weights of triangles
    Point3f p;
    Normal3f n;             // as SurfacePoint::ng
    float error = 0;        // as SurfacePoint::error
    float area_density = 0; // per area
};

// A point of a part, uniform over its area, except for quadrics under transforms that scale unevenly. Empty
// for degenerate triangles.
std::optional<EmissivePoint> sample_area(const LightContext& context, Index shape, Index part, Vec2f u);
// Density of sample_area at the point `p` of the part; 0 for degenerate triangles.
float area_density(const LightContext& context, Index shape, Index part, Point3f p);

} // namespace montelux
