// What the functions of a light read: the scene, and the place of the light in it.
#pragma once

#include "montelux/scene/view.h"

namespace montelux {

struct LightContext {
    const SceneView& scene;
    Index light; // into SceneView::lights

    const LightTablesView& tables() const { return scene.light_tables; }
};

} // namespace montelux
