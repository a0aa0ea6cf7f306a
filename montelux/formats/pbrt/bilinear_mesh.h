// The shape 'bilinearmesh' of a pbrt scene file.
#pragma once

#include "montelux/formats/pbrt/parameter_reader.h"
#include "montelux/scene/build/geometry.h"

namespace montelux::pbrt {

// Triangles where that is the same surface with the same normals and coordinates: for meshes of parallelograms
// without vertex normals. Lights are the exception, as they emit patch by patch.
Geometry read_bilinear_mesh(ParameterReader& r, const Transform& world_from_object, bool reverse_orientation,
                            bool emits);

} // namespace montelux::pbrt
