// montelux.Scene, as C++ sees it.
#pragma once

#include "python/src/scene_slots.h"
#include <memory>

namespace montelux::python {

struct SceneObject {
    std::shared_ptr<SceneHolder> holder = std::make_shared<SceneHolder>();
};

} // namespace montelux::python
