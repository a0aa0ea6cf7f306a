// LightContext: the inputs of a light's functions: the scene, and the light's index.
#pragma once

#include "montelux/scene/view.h"

namespace montelux {

struct LightContext {
    const SceneView& scene;
    Index light; // into SceneView::lights

    const LightTablesView& tables() const { return scene.light_tables; }
};

} // namespace montelux
