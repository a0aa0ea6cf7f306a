// The geometry of one shape before it is part of a scene, and what readers do to it.
#pragma once

#include <cstddef>
#include <variant>

#include "montelux/mc/math/transform.h"
#include "montelux/scene/shape/shape.h"

namespace montelux {

using Geometry = std::variant<TriangleMesh, Quadric>;

// Triangles of a mesh; a quadric is one.
std::size_t primitive_count(const Geometry& geometry);

// Moves vertices and vertex normals, which are also turned around with `reverse_orientation`.
void transform_mesh(TriangleMesh& mesh, const Transform& t, bool reverse_orientation = false);

// Throws Error, with the first triangle or vertex at fault: indices beyond the vertices or in no whole
// triangles, normals or texture coordinates that are not one per vertex, numbers that are not finite, bounds
// beyond single precision.
void check_geometry(const Geometry& geometry);

// The area in the space of the object, before its transformation.
float object_area(const Quadric& quadric);

} // namespace montelux
