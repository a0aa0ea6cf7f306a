// Normals of meshes whose files give none: smooth across edges, except where those are sharp.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "montelux/scene/shape/shape.h"

namespace montelux {

// Edges between triangles whose normals differ by more stay sharp.
inline constexpr double crease_degrees = 30;

// For each position the first one that is equal to it, so that triangles that share an edge share its indices.
std::vector<Index> welded(std::span<const Point3f> positions);

struct CornerNormals {
    std::vector<Normal3f> normals; // unit; zero where all triangles around are degenerate
    std::vector<Index> corners;    // one per entry of `indices`, into `normals`
};

// Around a vertex, triangles that are joined by smooth edges share a normal, the mean of theirs weighted by their
// angles there (Thuermer and Wuethrich 1998, "Computing Vertex Normals from Polygonal Facets"). `indices` are valid.
// `groups`: smoothing groups, one per triangle; edges within a group are smooth and others sharp, as are all edges
// of group 0. Empty: edges are sharp by `crease_degrees`.
CornerNormals corner_normals(std::span<const Point3f> positions, std::span<const Index> indices,
                             std::span<const std::uint32_t> groups = {});

// Gives a mesh without normals those of corner_normals; its vertices are split at sharp edges.
void add_normals(TriangleMesh& mesh);

// Gives a mesh without normals one for each vertex, smooth across all edges: the mean of its triangles' normals weighted
// by their angles there. `same`: for each vertex the one that it shares its normal with, such as `welded`; empty: none.
void add_smooth_normals(TriangleMesh& mesh, std::span<const Index> same = {});

} // namespace montelux
