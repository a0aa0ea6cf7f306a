// Normals that are made for meshes without.
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/formats/vertex_normals.h"
#include "montelux/mc/math/constants.h"

namespace montelux {
namespace {

// The sides of a prism around the z axis, each its own quad; vertices are not shared where `apart`.
TriangleMesh prism(int sides, bool apart) {
    TriangleMesh mesh;
    for (int i = 0; i < sides; ++i) {
        const auto corner = [&](int k, float z) {
            const double a = 2 * pi * (k % sides) / sides;
            return Point3f{static_cast<float>(std::cos(a)), static_cast<float>(std::sin(a)), z};
        };
        const auto first = static_cast<Index>(mesh.positions.size());
        if (apart) {
            for (const Point3f p : {corner(i, 0), corner(i + 1, 0), corner(i + 1, 1), corner(i, 1)})
                mesh.positions.push_back(p);
            mesh.indices.insert(mesh.indices.end(),
                                {first, first + 1, first + 2, first, first + 2, first + 3});
        } else {
            mesh.positions.push_back(corner(i, 0));
            mesh.positions.push_back(corner(i, 1));
            const auto n = static_cast<Index>(2 * sides);
            mesh.indices.insert(mesh.indices.end(),
                                {first, (first + 2) % n, (first + 3) % n, first, (first + 3) % n, first + 1});
        }
    }
    return mesh;
}

TEST(VertexNormals, RoundThingsAreSmooth) {
    for (const bool apart : {false, true}) {
        TriangleMesh mesh = prism(24, apart);
        const std::size_t vertices = mesh.positions.size();
        add_normals(mesh);
        EXPECT_EQ(mesh.positions.size(), vertices);
        for (std::size_t v = 0; v < vertices; ++v) {
            const Point3f p = mesh.positions[v];
            // By symmetry along the radius: both quads have the same angle at a vertex, if not both triangles.
            EXPECT_GT(dot(mesh.normals[v], Normal3f{p.x, p.y, 0}), 0.999f);
            EXPECT_NEAR(double(length(mesh.normals[v])), 1, 1e-6);
        }
    }
}

TEST(VertexNormals, SharpEdgesAreSplit) {
    TriangleMesh mesh = prism(4, false);
    add_normals(mesh);
    EXPECT_EQ(mesh.positions.size(), 16u);
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
        const auto at = [&](std::size_t k) { return mesh.indices[3 * t + k]; };
        const Vec3f face = normalize(cross(mesh.positions[at(1)] - mesh.positions[at(0)],
                                           mesh.positions[at(2)] - mesh.positions[at(0)]));
        for (std::size_t k = 0; k < 3; ++k) EXPECT_GT(dot(face, mesh.normals[at(k)]), 0.9999f);
    }
}

TEST(VertexNormals, TextureCoordinatesStay) {
    TriangleMesh mesh = prism(4, true);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) mesh.uvs.push_back({static_cast<float>(i), 0});
    const TriangleMesh before = mesh;
    add_normals(mesh);
    ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
    for (std::size_t c = 0; c < mesh.indices.size(); ++c) {
        EXPECT_EQ(mesh.uvs[mesh.indices[c]], before.uvs[before.indices[c]]);
        EXPECT_EQ(mesh.positions[mesh.indices[c]], before.positions[before.indices[c]]);
    }
}

TEST(VertexNormals, DegenerateTrianglesHaveNone) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    mesh.indices = {0, 1, 2, 1, 1, 1};
    add_normals(mesh);
    for (const Normal3f n : mesh.normals) EXPECT_EQ(n, Normal3f{});
    const std::vector<Point3f> same{{0, 0, 0}, {1, 0, 0}, {-0.0f, 0, 0}};
    EXPECT_EQ(welded(same), (std::vector<Index>{0, 1, 0}));
}

// Half of a fan has one normal and half another: each vertex of the hub has copies without end, but not for long.
TEST(VertexNormals, ManyTrianglesAroundAVertex) {
    TriangleMesh mesh;
    mesh.positions.push_back({0, 0, 0});
    for (int i = 0; i < 100000; ++i) {
        const auto n = static_cast<Index>(mesh.positions.size());
        mesh.positions.push_back({static_cast<float>(i), 1, 0});
        mesh.positions.push_back({static_cast<float>(i), 0, 1});
        mesh.indices.insert(mesh.indices.end(), {0, n, n + 1});
    }
    add_normals(mesh);
    EXPECT_EQ(mesh.triangle_count(), 100000u);
}

} // namespace
} // namespace montelux
