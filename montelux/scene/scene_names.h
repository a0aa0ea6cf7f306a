// Names of shapes, instances and materials, as the ids of a picture show them.
#pragma once

#include <string>
#include <vector>

#include "montelux/scene/scene.h"

namespace montelux {

// The name of the file, else "shape-N" or "material-N" by index.
std::string shape_name(const Scene& scene, Index shape);
std::string material_name(const Scene& scene, Index material);

// One per instance: that of its object, and ":K" for the K-th instance of the object, from 0 on. A single instance
// of an object without a name has the name of the object's first shape. Those of the parts of an object
// (ObjectDefinition::part_of) have the names of its own.
std::vector<std::string> instance_names(const Scene& scene);

} // namespace montelux
