// Shapes of a pbrt scene file: parameters to meshes and quadrics.
#pragma once

#include <variant>
#include <vector>

#include "montelux/formats/pbrt/files.h"
#include "montelux/formats/pbrt/parameter_reader.h"
#include "montelux/formats/pbrt/settings.h"
#include "montelux/scene/scene.h"

namespace montelux::pbrt {

// The geometry of one Shape directive.
struct Geometry {
    std::variant<TriangleMesh, Quadric> shape;

    std::size_t primitive_count() const;
};
// In the space of the object: what pbrt-v4 takes for the area of a light that has a power.
float object_area(const Quadric& quadric);

// Vertices of meshes are transformed by `world_from_object`; vertex normals too, and turned around with
// `reverse_orientation`. A quadric keeps the transform. `subdivided` counts the triangles of all 'loopsubdiv'
// shapes of the scene.
Geometry read_shape(ParameterReader& r, const std::string& plugin, const Transform& world_from_object,
                    bool reverse_orientation, Files& files, std::size_t& subdivided);

} // namespace montelux::pbrt
