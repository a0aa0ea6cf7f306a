// Geometry of the shapes of a Mitsuba scene: meshes in files, simple solids, curves.
#pragma once

#include "montelux/formats/mitsuba/plugin.h"
#include "montelux/scene/build/geometry.h"

namespace montelux::mitsuba {

struct PlacedGeometry {
    Geometry geometry;
    bool flip_normal = false; // ShapeSettings::flip_normal
};

// Of a shape that has geometry of its own: any but shapegroup, instance and merge. Its properties of all shapes
// (materials, media, lights) remain unread.
PlacedGeometry read_geometry(Plugin& shape);

} // namespace montelux::mitsuba
