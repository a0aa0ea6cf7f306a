// Triangle meshes from STL files (3D Systems 1989, "Stereolithography Interface Specification"), binary and ASCII.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "montelux/scene/shape/shape.h"

namespace montelux {

// Whether a binary file has exactly the size that its number of triangles asks for.
bool is_binary_stl(std::span<const std::uint8_t> bytes);

// Equal vertices are welded; the normals of facets are not used, and edges are smooth or sharp as in corner_normals.
// The two bytes behind a binary facet, which some programs use for colours, are ignored. Solids of one ASCII file
// become one mesh. Throws Error, prefixed with `name`, for data that end early, other text, and numbers that are not
// finite.
TriangleMesh parse_stl(std::span<const std::uint8_t> bytes, std::string_view name);

} // namespace montelux
