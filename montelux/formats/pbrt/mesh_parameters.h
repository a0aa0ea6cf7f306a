// Parameters that the meshes of a pbrt scene file share.
#pragma once

#include <string_view>

#include "montelux/formats/pbrt/parameter_reader.h"
#include "montelux/scene/shape/shape.h"

namespace montelux::pbrt {

// Indices as in the file: those of whole primitives of so many corners, each below `vertex_count`.
std::vector<Index> read_indices(ParameterReader& r, std::size_t vertex_count, std::size_t corners,
                                std::string_view primitive);

// The normals and texture coordinates of a mesh whose positions are known. Those that are not one per vertex
// are ignored with a warning.
void read_vertex_values(ParameterReader& r, TriangleMesh& mesh);
void read_vertex_values(ParameterReader& r, BilinearMesh& mesh);

} // namespace montelux::pbrt
