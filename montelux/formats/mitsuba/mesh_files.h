// Meshes of a Mitsuba scene: OBJ, PLY and serialized files.
#pragma once

#include "montelux/formats/mitsuba/plugin.h"
#include "montelux/scene/shape/shape.h"

namespace montelux::mitsuba {

// Of the shape's properties 'filename', 'face_normals', 'flip_tex_coords' and 'shape_index', in the space of the file.
// Meshes without normals get smooth ones, unless the shape asks for those of the faces.
TriangleMesh read_mesh_file(Plugin& shape);

} // namespace montelux::mitsuba
