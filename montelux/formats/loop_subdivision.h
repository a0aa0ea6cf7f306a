// Loop subdivision: a smooth limit surface of a coarse triangle mesh.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/math/vec.h"
#include "montelux/scene/index.h"

namespace montelux {

struct SubdividedMesh {
    std::vector<Vec3f> positions; // on the limit surface
    std::vector<Vec3f> normals;   // of the limit surface, not of unit length
    std::vector<Index> indices;
};

// Refines `levels` times, each triangle into four, then moves the vertices to the limit surface (Loop 1987,
// "Smooth Subdivision Surfaces Based on Triangles"; boundary rules, limit points and tangents of Hoppe et al.
// 1994, "Piecewise Smooth Surface Reconstruction", appendix). Normals point to the side from which a
// triangle's vertices run clockwise, as pbrt's do. `indices` must lie within `positions`. Throws Error when
// an edge has more than two triangles or two that run through it in the same direction, or when the result
// would have more than 2^28 triangles.
SubdividedMesh subdivide_loop(std::span<const Vec3f> positions, std::span<const Index> indices, int levels);

} // namespace montelux
