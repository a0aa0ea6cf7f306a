// raised_position: a point above a coarse mesh, on the smooth surface that its vertex normals stand for.
#pragma once

#include <optional>

#include "montelux/scene/shape/surface_point.h"

namespace montelux {

// Whether the shape is a triangle mesh with vertex normals.
bool has_vertex_normals(const SceneView& scene, const Shape& shape);

// Where light is gathered for the point s of a hit so that facets do not shadow the smooth surface that the shading
// normals describe: s.p, moved towards the ray's side to the mean of its projections onto the tangent planes of the
// three vertices, weighted by its barycentric coordinates (Hanika 2021, "Hacking the Shadow Terminator", Ray Tracing
// Gems II, chapter 4). Vertices whose planes lie behind s.p, as in hollows, do not move it. Empty where facet and
// normal agree, and where the ray comes from different sides of the two.
std::optional<Point3f> raised_position(const SceneView& scene, const Ray& ray, const Hit& hit,
                                       const SurfacePoint& s);

} // namespace montelux
