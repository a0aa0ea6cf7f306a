// montelux.Scene, as C++ sees it.
#pragma once

#include "python/src/scene_slots.h"
#include <cstdint>
#include <memory>
#include <optional>

namespace montelux::python {

struct SceneObject {
    std::shared_ptr<SceneHolder> holder = std::make_shared<SceneHolder>();
};

// What a render of the scene reads, with these samples and this seed where given. Throws Error for a scene without a
// camera or with materials that are not right.
std::shared_ptr<const SceneDescription>
description_of(const SceneObject& scene, std::optional<std::uint32_t> spp, std::optional<std::uint64_t> seed);

} // namespace montelux::python
