// LightContext: the inputs of a light's functions: the scene, the light's index and the time.
#pragma once

#include "montelux/scene/view.h"

namespace montelux {

struct LightContext {
    const SceneView& scene;
    Index light;    // into SceneView::lights
    float time = 0; // of motions, in [0, 1]

    const LightTablesView& tables() const { return scene.light_tables; }
};

} // namespace montelux
