// BilinearMesh: bilinear patches that share vertices.
#pragma once

#include <cstddef>
#include <vector>

#include "montelux/scene/index.h"
#include "montelux/scene/shape/bilinear_patch.h"
#include "montelux/scene/shape/bounds.h"

namespace montelux {

// Positions are in world space, or in the space of the object definition. `normals` and `uvs` are empty or one
// per vertex; without uvs, those of a patch are its own u and v. The builder checks the indices.
struct BilinearMesh {
    std::vector<Point3f> positions;
    std::vector<Normal3f> normals;
    std::vector<Point2f> uvs;
    std::vector<Index> indices; // four per patch: p(0, 0), p(1, 0), p(0, 1), p(1, 1)

    std::size_t patch_count() const { return indices.size() / 4; }
    BilinearPatch patch(std::size_t i) const {
        const Index* v = &indices[4 * i];
        return {Vec3d(positions[v[0]]), Vec3d(positions[v[1]]), Vec3d(positions[v[2]]),
                Vec3d(positions[v[3]])};
    }
    Bounds3 patch_bounds(std::size_t i) const {
        Bounds3 b;
        for (std::size_t k = 0; k < 4; ++k) b.add(Vec3d(positions[indices[4 * i + k]]));
        return b;
    }
};

} // namespace montelux
