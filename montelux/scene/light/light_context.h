// What the functions of a light read: the scene, its tables, and the place of the light in both.
#pragma once

#include "montelux/scene/scene.h"
#include "montelux/scene/scene_tables.h"

namespace montelux {

struct LightContext {
    const Scene& scene;
    const SceneTables& tables;
    Index light; // into Scene::lights

    const LightTables& lights() const { return tables.lights(); }
};

} // namespace montelux
