// Points of emissive shapes: triangles, patches, discs, spheres and other quadrics, and their place in the world.
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

// The triangle of a mesh as it is at that time, in the space of the mesh.
LightTriangle light_triangle(const TriangleMesh& mesh, const Shape& shape, std::size_t primitive,
                             float time = 0);

// The two functions below are in the space of the shape at the context's time: of an EmitterPlace, or the world.

// A point of a part, uniform over its area, except for quadrics under transforms that scale unevenly and patches
// that are no parallelograms. Empty for degenerate triangles and patches.
std::optional<EmissivePoint> sample_area(const LightContext& context, Index shape, Index part, Vec2f u);
// Density of sample_area at a point of the shape; 0 for degenerate triangles and patches.
float area_density(const LightContext& context, Index shape, const LightHit& hit);

// Where the instance of an emissive shape is at the context's time.
class EmitterPlace {
  public:
    EmitterPlace(const LightContext& context, Index instance);

    const Transform& world_from_shape() const { return world_from_shape_; }
    // Brings a point from the shape's space to the world.
    void move(EmissivePoint& point) const;
    // Area in the world over area in the shape's space, at a point with that unit normal in the world.
    float area_scale(Normal3f n) const;

  private:
    Transform world_from_shape_;
    float error_ = 0; // of the ray tracer's interpolation between the keys of a motion
};
// The quadric as the transformation places it.
Quadric placed(Quadric quadric, const Transform& world_from_shape);

} // namespace montelux
