// A wavy surface: triangles with the normals of a smooth height field.
#pragma once

#include <cmath>

#include "montelux/mc/math/transform.h"
#include "montelux/scene/shape/shape.h"

namespace montelux::testing {

// Over [-1, 1]^2 of the space of `t`, in so many cells each way; heights are of the order of slope / 5.
inline TriangleMesh wavy_mesh(double slope, int cells, const Transform& t) {
    TriangleMesh mesh;
    const double height = slope / 5;
    for (int j = 0; j <= cells; ++j)
        for (int i = 0; i <= cells; ++i) {
            const double x = 2.0 * i / cells - 1, y = 2.0 * j / cells - 1;
            mesh.positions.push_back(Vec3f(t.point(Vec3d{x, y, height * std::sin(5 * x) * std::cos(4 * y)})));
            const Vec3d n{-5 * height * std::cos(5 * x) * std::cos(4 * y),
                          4 * height * std::sin(5 * x) * std::sin(4 * y), 1};
            mesh.normals.push_back(Vec3f(normalize(t.normal(n))));
        }
    for (int j = 0; j < cells; ++j)
        for (int i = 0; i < cells; ++i) {
            const auto a = static_cast<Index>(j * (cells + 1) + i), b = a + static_cast<Index>(cells) + 1;
            for (const Index k : {a, a + 1, b + 1, a, b + 1, b}) mesh.indices.push_back(k);
        }
    return mesh;
}

} // namespace montelux::testing
