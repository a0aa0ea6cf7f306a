// Geometry: the geometry of one shape before it is part of a scene, and operations of readers on it.
#pragma once

#include <cstddef>
#include <variant>

#include "montelux/mc/math/transform.h"
#include "montelux/scene/shape/shape.h"

namespace montelux {

using Geometry = std::variant<TriangleMesh, Quadric, Curves, BilinearMesh>;

// Number of primitives: the triangles or patches of a mesh, the segments of curves, or one quadric.
std::size_t primitive_count(const Geometry& geometry);

// Transforms vertices and vertex normals; `reverse_orientation` reverses the normals.
void transform_mesh(TriangleMesh& mesh, const Transform& t, bool reverse_orientation = false);
void transform_mesh(BilinearMesh& mesh, const Transform& t, bool reverse_orientation = false);

// Throws Error, naming the first primitive or vertex at fault: indices out of range or not in whole primitives,
// normals or texture coordinates not one per vertex, non-finite numbers, bounds beyond single precision.
void check_geometry(const Geometry& geometry);

// The area in the space of the object, before its transformation.
float object_area(const Quadric& quadric);

} // namespace montelux
