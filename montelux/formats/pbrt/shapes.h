// Shapes of a pbrt scene file: parameters to meshes and quadrics.
#pragma once

#include <string>

#include "montelux/formats/loop_subdivision.h"
#include "montelux/formats/pbrt/displacement.h"
#include "montelux/formats/pbrt/files.h"
#include "montelux/formats/pbrt/parameter_reader.h"
#include "montelux/formats/pbrt/settings.h"
#include "montelux/scene/build/geometry.h"

namespace montelux::pbrt {

// The geometry of one Shape directive. Vertices of meshes are transformed by `world_from_object`; vertex normals too,
// and turned around with `reverse_orientation`. A quadric keeps the transform. `budget` is that of all 'loopsubdiv'
// shapes of the scene. `emits`: it is an area light. `displacement_space` is the transform for displacement: that of
// the shape in the world, of a moving one at the start.
Geometry read_shape(ParameterReader& r, const std::string& plugin, const Transform& world_from_object,
                    bool reverse_orientation, bool emits, Files& files, SubdivisionBudget& budget,
                    DisplacementReader& displacements, const Transform& displacement_space);

} // namespace montelux::pbrt
