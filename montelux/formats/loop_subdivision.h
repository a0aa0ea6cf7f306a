// Loop subdivision: a smooth limit surface of a coarse triangle mesh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/math/vec.h"
#include "montelux/scene/index.h"

namespace montelux {

// Peak memory is about 80 bytes per triangle: 2.5 GiB in all.
inline constexpr std::size_t max_subdivided_triangles = std::size_t{1} << 25;
// The number of triangles after subdivision; saturates at the largest integer.
std::size_t subdivided_count(std::size_t triangles, int levels);

// The triangles of all subdivided meshes of a scene, and how many there may be: a few lines of text must not make a
// mesh of millions.
struct SubdivisionBudget {
    std::size_t control = 0, refined = 0; // triangles before and after subdivision

    // 2^22, or 5 levels of all meshes if that is more, up to max_subdivided_triangles.
    std::size_t limit() const;
    // Whether a mesh of so many triangles may be refined too; if so, counts it.
    bool take(std::size_t triangles, int levels);
};

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
// would have more than `max_subdivided_triangles`.
SubdividedMesh subdivide_loop(std::span<const Vec3f> positions, std::span<const Index> indices, int levels);

} // namespace montelux
