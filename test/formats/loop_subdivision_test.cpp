#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <set>
#include <utility>

#include "montelux/formats/loop_subdivision.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

struct Coarse {
    std::vector<Vec3f> positions;
    std::vector<Index> indices;
};

Coarse octahedron() {
    return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
            {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5}};
}

// A flat n x n grid of vertices in the plane z = 0, triangles anticlockwise from +z.
Coarse grid(Index n) {
    Coarse c;
    for (Index y = 0; y < n; ++y)
        for (Index x = 0; x < n; ++x)
            c.positions.push_back({static_cast<float>(x), static_cast<float>(y), 0});
    for (Index y = 0; y + 1 < n; ++y)
        for (Index x = 0; x + 1 < n; ++x) {
            Index a = y * n + x, b = a + 1, d = a + n, e = d + 1;
            c.indices.insert(c.indices.end(), {a, b, e, a, e, d});
        }
    return c;
}

TEST(LoopSubdivision, CountsAndTopologyOfAClosedMesh) {
    Coarse c = octahedron();
    for (int levels = 0; levels <= 4; ++levels) {
        SubdividedMesh m = subdivide_loop(c.positions, c.indices, levels);
        std::size_t triangles = 8u << (2 * levels);
        EXPECT_EQ(m.indices.size(), 3 * triangles);
        EXPECT_EQ(m.positions.size(), triangles / 2 + 2); // Euler: V - E + F = 2, E = 3 F / 2
        EXPECT_EQ(m.normals.size(), m.positions.size());
        std::set<std::pair<Index, Index>> edges;
        for (std::size_t i = 0; i < m.indices.size(); i += 3)
            for (std::size_t k = 0; k < 3; ++k)
                EXPECT_TRUE(edges.emplace(m.indices[i + k], m.indices[i + (k + 1) % 3]).second);
        for (auto [a, b] : edges) EXPECT_TRUE(edges.contains({b, a}));
    }
}

// By symmetry a vertex of valence 4 goes to (1 - 4 b) v in one step, b = 3/32; its ring's centre stays 0.
TEST(LoopSubdivision, LimitPointsOfTheOctahedron) {
    Coarse c = octahedron();
    // Limit weight of the ring: 1 / (n + 3 / (8 b)) with b = 3/32 is 1/8 each, so the vertex keeps one half.
    SubdividedMesh m = subdivide_loop(c.positions, c.indices, 0);
    EXPECT_NEAR(m.positions[0].x, 0.5f, 1e-6f);
    // The limit does not depend on how often the mesh was refined before.
    for (int levels = 1; levels <= 4; ++levels) {
        SubdividedMesh fine = subdivide_loop(c.positions, c.indices, levels);
        for (std::size_t v = 0; v < 6; ++v)
            EXPECT_LT(length(fine.positions[v] - m.positions[v]), 1e-6f) << levels;
        // Normals point to the clockwise side: inward here.
        for (std::size_t v = 0; v < fine.positions.size(); ++v)
            EXPECT_LT(dot(normalize(fine.normals[v]), normalize(fine.positions[v])), -0.95f);
    }
}

// Valence 3 has weights of its own: the limit is (1 - 3/5) v + (1/5) (-v).
TEST(LoopSubdivision, LimitPointsOfTheTetrahedron) {
    std::vector<Vec3f> p = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    std::vector<Index> i = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2};
    for (int levels = 0; levels <= 3; ++levels) {
        SubdividedMesh m = subdivide_loop(p, i, levels);
        for (std::size_t v = 0; v < 4; ++v) EXPECT_LT(length(m.positions[v] - p[v] * 0.2f), 1e-6f) << levels;
    }
}

TEST(LoopSubdivision, APlaneStaysInItsPlane) {
    Coarse c = grid(5);
    SubdividedMesh m = subdivide_loop(c.positions, c.indices, 2);
    for (std::size_t v = 0; v < m.positions.size(); ++v) {
        EXPECT_EQ(m.positions[v].z, 0);
        EXPECT_LT(m.normals[v].z, 0);
        EXPECT_EQ(m.normals[v].x, 0);
        EXPECT_TRUE(m.positions[v].x >= 0 && m.positions[v].x <= 4);
    }
    // Inner vertices of a regular grid are where they were, and so are edges away from corners.
    EXPECT_LT(length(m.positions[2 * 5 + 2] - Vec3f(2, 2, 0)), 1e-6f);
    EXPECT_LT(length(m.positions[2] - Vec3f(2, 0, 0)), 1e-6f);
}

// A boundary vertex at `at` with `neighbours` around it, which are not in a plane; triangles anticlockwise from +z.
Coarse boundary_fan(Index neighbours, Vec3f at) {
    constexpr std::array<Vec3f, 7> around = {Vec3f(4, 0, 1), {3, 2, 0},  {1, 4, -1}, {-1, 4, 2},
                                             {-3, 2, 0},     {-4, 0, 1}, {-3, -2, 3}};
    Coarse c;
    c.positions.push_back(at);
    for (Index k = 0; k < neighbours; ++k) c.positions.push_back(at + around.at(k));
    for (Index k = 1; k < neighbours; ++k) c.indices.insert(c.indices.end(), {0, k, k + 1});
    return c;
}

// The weights of a tangent mask sum to 0.
TEST(LoopSubdivision, NormalsOnABoundaryDoNotDependOnThePlace) {
    for (Index neighbours = 2; neighbours <= 7; ++neighbours) {
        const Coarse here = boundary_fan(neighbours, {0, 0, 0}),
                     there = boundary_fan(neighbours, {16, -32, 8});
        for (int levels = 0; levels <= 2; ++levels) {
            const SubdividedMesh a = subdivide_loop(here.positions, here.indices, levels);
            const SubdividedMesh b = subdivide_loop(there.positions, there.indices, levels);
            ASSERT_EQ(a.normals.size(), b.normals.size());
            for (std::size_t v = 0; v < a.normals.size(); ++v)
                EXPECT_LT(length(a.normals[v] - b.normals[v]), 1e-5f * length(a.normals[v]))
                    << "vertex " << v << " of " << neighbours << " neighbours, level " << levels;
        }
    }
}

// Four triangles are steps of 45 degrees: inner neighbours weigh (2 - 2 cos 45) sin(k 45), the two on the boundary
// -sin 45.
TEST(LoopSubdivision, NormalOfABoundaryVertexOfFourTriangles) {
    const Coarse c = boundary_fan(5, {0, 0, 0});
    const SubdividedMesh m = subdivide_loop(c.positions, c.indices, 0);
    const std::vector<Vec3f>& p = m.positions;
    const float sqrt_2 = std::sqrt(2.f);
    const Vec3f across = (sqrt_2 - 1) * (p[2] + p[4]) + (2 - sqrt_2) * p[3] - sqrt_2 / 2 * (p[1] + p[5]);
    const Vec3f expected = cross(p[5] - p[1], across);
    EXPECT_LT(length(m.normals[0] - expected), 1e-5f * length(expected));
}

TEST(LoopSubdivision, UnusedVerticesAndSingleTriangles) {
    std::vector<Vec3f> p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 9, 9}};
    std::vector<Index> i = {0, 1, 2};
    SubdividedMesh m = subdivide_loop(p, i, 1);
    EXPECT_EQ(m.indices.size(), 12u);
    EXPECT_EQ(m.positions[3], Vec3f(9, 9, 9));
    EXPECT_LT(length(m.positions[0] - Vec3f(0.15f, 0.15f, 0)), 0.1f);
}

TEST(LoopSubdivision, RefusesBadMeshes) {
    std::vector<Vec3f> p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::vector<Index> twice = {0, 1, 2, 0, 1, 3};
    EXPECT_THROW(subdivide_loop(p, twice, 1), Error);
    std::vector<Index> degenerate = {0, 0, 1};
    EXPECT_THROW(subdivide_loop(p, degenerate, 1), Error);
    std::vector<Index> one = {0, 1, 2};
    EXPECT_THROW(subdivide_loop(p, one, 15), Error);
    EXPECT_THROW(subdivide_loop(p, one, 2000000000), Error);
}

} // namespace
} // namespace montelux
