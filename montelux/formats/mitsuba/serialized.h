// Meshes of Mitsuba's binary format ".serialized" (versions 3 to 5).
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "montelux/scene/shape/shape.h"

namespace montelux::mitsuba {

struct SerializedMesh {
    TriangleMesh mesh;
    bool face_normals = false; // the file asks for the normals of its faces
};

// The mesh of that number, from 0. Colours of vertices and further attributes are skipped. Allocates no more than the
// file's size justifies. Throws Error, prefixed with `name`, for other files, numbers that are not in the file, data
// that is damaged, ends early or is out of proportion, and indices out of range.
SerializedMesh parse_serialized(std::span<const std::uint8_t> bytes, std::string_view name,
                                std::uint32_t number);

} // namespace montelux::mitsuba
