// Displacement of triangle meshes: refined to short edges, then moved along the normals by heights.
#pragma once

#include <cstddef>
#include <span>

#include "montelux/scene/shape/shape.h"

namespace montelux {

// Peak memory is about 100 bytes per triangle.
inline constexpr std::size_t max_displaced_triangles = std::size_t{1} << 25;

// Bisects triangles at their longest edge until no edge, measured in the space of `world_from_object`, is as
// long as `edge_length` (Rivara 1984, "Algorithms for refining triangular grids"). Neighbours split the edge
// that they share at the same point, so no cracks open. Midpoints interpolate texture coordinates and normals,
// which become unit vectors; a mesh without normals gets those of its faces, averaged at each vertex. Returns
// false, with the mesh unfinished, if there would be more than `most` triangles.
bool refine_edges(TriangleMesh& mesh, const Transform& world_from_object, float edge_length,
                  std::size_t most);

// Moves vertex i by heights[i] along its normal (of unit length, one per vertex). Vertices at one point, as
// along seams of texture coordinates, move together, by the mean of their displacements: what was closed stays
// closed. The new normals are averages over the faces, on the side of the old ones; vertices at one point share
// theirs if they shared it before.
void displace_vertices(TriangleMesh& mesh, std::span<const float> heights);

} // namespace montelux
