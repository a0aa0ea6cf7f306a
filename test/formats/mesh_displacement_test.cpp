// Displacement of meshes: refinement without cracks, displaced seams, normals, limits.
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <set>
#include <tuple>

#include "montelux/formats/mesh_displacement.h"

namespace montelux {
namespace {

using Place = std::tuple<float, float, float>;

Place place_of(const TriangleMesh& mesh, Index v) {
    const Point3f p = mesh.positions[v];
    return {p.x, p.y, p.z};
}

// Edges by the places of their ends, of which a closed mesh has each once in either direction.
bool closes(const TriangleMesh& mesh) {
    std::map<std::pair<Place, Place>, int> edges;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k)
            ++edges[{place_of(mesh, mesh.indices[i + k]), place_of(mesh, mesh.indices[i + (k + 1) % 3])}];
    for (const auto& [edge, count] : edges)
        if (count != 1 || !edges.contains({edge.second, edge.first})) return false;
    return true;
}

double volume_of(const TriangleMesh& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        sum += dot(Vec3d(mesh.positions[mesh.indices[i]]), cross(Vec3d(mesh.positions[mesh.indices[i + 1]]),
                                                                 Vec3d(mesh.positions[mesh.indices[i + 2]])));
    return sum / 6;
}

double longest_edge(const TriangleMesh& mesh) {
    double longest = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k)
            longest = std::max(longest, length(Vec3d(mesh.positions[mesh.indices[i + k]]) -
                                               Vec3d(mesh.positions[mesh.indices[i + (k + 1) % 3]])));
    return longest;
}

TriangleMesh unit_octahedron() {
    TriangleMesh m;
    m.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    m.normals = m.positions;
    m.indices = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    return m;
}

// The cube [0, 1]^3 of six squares with four vertices each: a crease of normals along every edge.
TriangleMesh creased_cube(bool with_normals) {
    TriangleMesh m;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            const auto base = static_cast<Index>(m.positions.size());
            for (int corner = 0; corner < 4; ++corner) {
                Point3f p;
                p[axis] = static_cast<float>(side);
                p[(axis + 1) % 3] = static_cast<float>((corner == 1 || corner == 2) ? 1 : 0);
                p[(axis + 2) % 3] = static_cast<float>(corner >= 2 ? 1 : 0);
                m.positions.push_back(p);
                m.uvs.push_back({p[(axis + 1) % 3], p[(axis + 2) % 3]});
                Normal3f n{0, 0, 0};
                n[axis] = side == 1 ? 1.0f : -1.0f;
                if (with_normals) m.normals.push_back(n);
            }
            const std::array<Index, 6> front = {0, 1, 2, 0, 2, 3}, back = {0, 2, 1, 0, 3, 2};
            for (const Index i : side == 1 ? front : back) m.indices.push_back(base + i);
        }
    return m;
}

TEST(MeshDisplacement, RefinesToEdgesWithoutCracks) {
    for (const float longest : {2.0f, 0.5f, 0.11f}) {
        for (TriangleMesh mesh : {unit_octahedron(), creased_cube(true), creased_cube(false)}) {
            const double before = volume_of(mesh);
            ASSERT_TRUE(refine_edges(mesh, Transform(), longest, 1 << 20));
            EXPECT_LT(longest_edge(mesh), static_cast<double>(longest));
            EXPECT_TRUE(closes(mesh));
            EXPECT_NEAR(volume_of(mesh), before, 1e-5);
            EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
            if (!mesh.uvs.empty()) {
                EXPECT_EQ(mesh.uvs.size(), mesh.positions.size());
            }
        }
    }
    // An edge as long as the limit is split, as in pbrt-v4; edges are measured in the world.
    TriangleMesh right;
    right.positions = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}};
    right.uvs = {{0, 0}, {1, 0}, {0, 1}};
    right.indices = {0, 1, 2};
    TriangleMesh split = right;
    ASSERT_TRUE(refine_edges(split, Transform::scale({2, 2, 2}), 10, 100));
    EXPECT_EQ(split.triangle_count(), 2u);
    EXPECT_EQ(split.positions[3], (Point3f{1.5f, 2, 0}));
    EXPECT_EQ(split.uvs[3], (Point2f{0.5f, 0.5f}));
    split = right;
    ASSERT_TRUE(refine_edges(split, Transform::scale({2, 2, 2}), 10.01f, 100));
    EXPECT_EQ(split.triangle_count(), 1u);
}

TEST(MeshDisplacement, MovesVerticesAlongNormals) {
    TriangleMesh mesh;
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 2; ++x)
            mesh.positions.push_back({static_cast<float>(x), static_cast<float>(y), 3});
    mesh.indices = {0, 1, 3, 0, 3, 2};
    ASSERT_TRUE(refine_edges(mesh, Transform(), 0.1f, 10000));
    std::vector<float> heights;
    for (const Point3f p : mesh.positions) heights.push_back(0.5f * p.x);
    displace_vertices(mesh, heights);
    const Vec3d slope = normalize(Vec3d{-0.5, 0, 1});
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        EXPECT_FLOAT_EQ(mesh.positions[v].z, 3 + 0.5f * mesh.positions[v].x);
        EXPECT_LT(length(Vec3d(mesh.normals[v]) - slope), 1e-5);
    }
}

TEST(MeshDisplacement, SeamsAndCreasesStayClosed) {
    for (const bool with_normals : {true, false}) {
        TriangleMesh mesh = creased_cube(with_normals);
        ASSERT_TRUE(refine_edges(mesh, Transform(), 0.15f, 100000));
        std::vector<float> heights; // differ between the two sides of an edge
        for (const Point2f uv : mesh.uvs) heights.push_back(0.1f * std::sin(7 * uv.x) + 0.02f * uv.y);
        displace_vertices(mesh, heights);
        EXPECT_TRUE(closes(mesh));
        // A crease stays one: two vertices at a place on an edge have normals of their own.
        bool differs = false;
        std::map<Place, Normal3f> first;
        for (Index v = 0; v < mesh.positions.size(); ++v)
            differs = differs || dot(first.emplace(place_of(mesh, v), mesh.normals[v]).first->second,
                                     mesh.normals[v]) < 0.7f;
        EXPECT_TRUE(differs);
    }
    // Constant heights make a creased cube larger by the same on each side, away from its edges.
    TriangleMesh cube = creased_cube(true);
    ASSERT_TRUE(refine_edges(cube, Transform(), 0.15f, 100000));
    displace_vertices(cube, std::vector<float>(cube.positions.size(), 0.25f));
    float most = 0;
    for (const Point3f p : cube.positions) most = std::max(most, p.x);
    EXPECT_EQ(most, 1.25f);
}

// At a seam of a plane both sides move by the mean of what they would move.
TEST(MeshDisplacement, SeamsMoveByTheMean) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.indices = {0, 1, 2, 3, 4, 5};
    ASSERT_TRUE(refine_edges(mesh, Transform(), 10, 10));
    displace_vertices(mesh, std::vector<float>{0.1f, 0.2f, 0.5f, 0.4f, 0.3f, 0.1f});
    const float heights[] = {0.1f, 0.3f, 0.3f, 0.3f, 0.3f, 0.3f};
    for (std::size_t v = 0; v < 6; ++v) EXPECT_FLOAT_EQ(mesh.positions[v].z, heights[v]) << v;
}

TEST(MeshDisplacement, NormalsKeepTheirSide) {
    for (const float sign : {1.0f, -1.0f}) {
        TriangleMesh mesh = unit_octahedron();
        for (Normal3f& n : mesh.normals) n = sign * n;
        ASSERT_TRUE(refine_edges(mesh, Transform(), 0.2f, 100000));
        displace_vertices(mesh, std::vector<float>(mesh.positions.size(), 0.1f));
        EXPECT_TRUE(closes(mesh));
        for (std::size_t v = 0; v < mesh.positions.size(); ++v)
            EXPECT_GT(sign * dot(mesh.normals[v], mesh.positions[v]), 0);
        EXPECT_EQ(volume_of(mesh) > 4.0 / 3, sign > 0); // grows outwards, shrinks inwards
    }
}

// Heights are lengths, whatever the length of the normals that a file gives; every face counts the same in the new ones.
TEST(MeshDisplacement, NormalsAreUnitAverages) {
    TriangleMesh mesh = unit_octahedron();
    for (Normal3f& n : mesh.normals) n = 3.0f * n;
    ASSERT_TRUE(refine_edges(mesh, Transform(), 0.3f, 100000));
    for (const Normal3f n : mesh.normals) EXPECT_NEAR(length(n), 1, 1e-6);
    const TriangleMesh before = mesh;
    displace_vertices(mesh, std::vector<float>(mesh.positions.size(), 0.1f));
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        EXPECT_LT(length(mesh.positions[v] - (before.positions[v] + 0.1f * before.normals[v])), 1e-6f);

    // Two faces at a right angle, one ten times as large.
    TriangleMesh wedge;
    wedge.positions = {{0, 0, 0}, {1, 0, 0}, {0.5f, 10, 0}, {0.5f, 0, -1}};
    wedge.indices = {0, 1, 2, 1, 0, 3};
    ASSERT_TRUE(refine_edges(wedge, Transform(), 100, 10));
    const Vec3d expected = normalize(Vec3d{0, -1, 1});
    for (const Index v : {0u, 1u}) EXPECT_LT(length(Vec3d(wedge.normals[v]) - expected), 1e-6);
    displace_vertices(wedge, std::vector<float>(4));
    for (const Index v : {0u, 1u}) EXPECT_LT(length(Vec3d(wedge.normals[v]) - expected), 1e-6);
}

TEST(MeshDisplacement, StopsAtTheLimit) {
    TriangleMesh mesh = unit_octahedron();
    EXPECT_FALSE(refine_edges(mesh, Transform(), 1e-9f, max_displaced_triangles)); // by its area, at once
    mesh = unit_octahedron();
    EXPECT_FALSE(refine_edges(mesh, Transform(), 0.5f, 40));
    // A needle without area, of coordinates that cannot be halved: ends by the count.
    TriangleMesh needle;
    needle.positions = {{1e6f, 0, 0}, {1e6f + 0.0625f, 0, 0}, {1e6f, 0, 0}};
    needle.indices = {0, 1, 2};
    EXPECT_FALSE(refine_edges(needle, Transform(), 1e-9f, 1000));
}

} // namespace
} // namespace montelux
