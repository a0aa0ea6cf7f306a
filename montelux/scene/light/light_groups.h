// LightGroups: the lights of a scene in groups, each a layer of the picture.
#pragma once

#include <string>
#include <vector>

#include "montelux/scene/film/layer_set.h"
#include "montelux/scene/scene.h"

namespace montelux {

struct LightGroups {
    std::vector<std::string> names; // as parts of channel names: without dots and control characters
    std::vector<Index> of_light;    // into `names`
    Index of_media = no_index;      // of the emission of media; no_index: the scene has none
};

// Lights with the same name in Scene::light_groups form a group; the others as `grouping` says. Throws Error, with
// what to do, if there are more groups than an EXR file holds.
LightGroups light_groups(const Scene& scene, LightGrouping grouping);

} // namespace montelux
