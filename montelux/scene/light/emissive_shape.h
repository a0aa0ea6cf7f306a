// Points of emissive shapes: triangles, patches, discs, spheres and other quadrics.
#pragma once

#include <optional>

#include "montelux/scene/light/light_context.h"
#include "montelux/scene/light/light_model.h"
#include "montelux/scene/shape/surface_point.h"

namespace montelux {

// A point on an emissive shape.
struct EmissivePoint {
    Hit hit; // without distance
    Point3f p;
    Normal3f n;             // as SurfacePoint::ng
    float error = 0;        // as SurfacePoint::error
    float area_density = 0; // per area
};

// A point of a part, uniform over its area, except for quadrics under transforms that scale unevenly and patches
// that are no parallelograms. Empty for degenerate triangles and patches.
std::optional<EmissivePoint> sample_area(const LightContext& context, Index shape, Index part, Vec2f u);
// Density of sample_area at a point of the shape; 0 for degenerate triangles and patches.
float area_density(const LightContext& context, Index shape, const LightHit& hit);

} // namespace montelux
