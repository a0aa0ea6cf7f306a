// The lists of a scene's materials, lights and shapes, as Python sees them.
#pragma once

#include "python/src/shapes.h"

namespace montelux::python {

// A list of slots of a scene, as Python sees it. Lights of one shape are one entry.
struct MaterialList {
    SceneRef scene;
};
struct LightList {
    SceneRef scene;
};
struct ShapeList {
    SceneRef scene;
};

} // namespace montelux::python
