// Triangle meshes from PLY files (Turk 1994, "The PLY Polygon File Format").
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "montelux/mc/io/file.h"
#include "montelux/scene/shape/shape.h"

namespace montelux {

struct PlyMesh {
    TriangleMesh mesh;
    std::size_t quads = 0;      // faces of four corners, split into two triangles along corners 0 and 2
    std::size_t polygons = 0;   // faces of more corners, split into a fan around corner 0
    std::size_t degenerate = 0; // faces of fewer than three corners, left out
    bool has_colors = false;    // of vertices
};

// ASCII and binary, little and big endian, properties of any type in any order. Vertices: x, y, z; optional
// nx, ny, nz; optional u, v (also s, t; texture_u, texture_v; texture_s, texture_t) and u2, v2; with `colors` also red, green, blue
// (also diffuse_red ...; r, g, b; color_0, color_1, color_2), which are sRGB where they are integers and linear where they are floats, and alpha. Faces: a list
// vertex_indices or vertex_index. Triangle strips: an element tristrips with such a list, in which -1 begins a new strip.
// Other elements and properties are skipped.
// Allocates no more than the file's size justifies. Throws Error, prefixed with `name`, for a wrong header,
// data that ends early, numbers that cannot be read or are not finite, and vertex indices out of range.
PlyMesh parse_ply(std::span<const std::uint8_t> bytes, std::string_view name, bool colors = false);

// The same for a file, which may be gzipped (".gz").
PlyMesh read_ply(const std::filesystem::path& path);

// A binary file (little endian, floats) of the mesh as it is at the start, with these normals, which are none or one per
// vertex, in place of its own.
void write_ply(AtomicFile& file, const TriangleMesh& mesh, std::span<const Normal3f> normals);

} // namespace montelux
