// Geometry from OBJ files (Wavefront, "Object Files (.obj)", version 3.0): triangle meshes with the names of materials.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/formats/warnings.h"
#include "montelux/scene/shape/shape.h"

namespace montelux {

// The faces of one object or group with one material.
struct ObjPart {
    std::string name;     // of `o`, or of `g` where there is none; may be empty
    std::string material; // of `usemtl`; may be empty
    std::size_t line = 1; // of the first face
    TriangleMesh mesh;
};

struct ObjLibrary {
    std::string file; // of `mtllib`, as written
    std::size_t line = 1;
};

struct ObjModel {
    std::vector<ObjPart> parts; // in the order of their first faces
    std::vector<ObjLibrary> libraries;
};

struct ObjSettings {
    bool split = true; // false: all faces are one part, that of the first one
    // Faces without normals get those of corner_normals, by the file's smoothing groups where it has any.
    bool make_normals = true;
    // Vertices get the colours behind their coordinates, as written; white where others alone have any.
    bool colors = false;
};

// Reads v, vt, vn, f, o, g, usemtl, mtllib and s; faces of any number of corners, indices that count from either end,
// lines that end in a backslash. Warns once of everything else, which is ignored. Corners without texture coordinates
// have (0, 0) in a part where others have some.
// Allocates no more than the file's size justifies. Throws Error "name:line: sentence" for numbers that cannot be read
// or are beyond single precision, missing ones, and indices of vertices that are not defined before.
ObjModel parse_obj(std::span<const std::uint8_t> bytes, std::string_view name, Warnings& warnings,
                   const ObjSettings& settings = {});

} // namespace montelux
