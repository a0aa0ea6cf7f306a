// The cameras and lights of a glTF file, at nodes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "montelux/formats/gltf/document.h"
#include "montelux/formats/gltf/pose.h"
#include "montelux/scene/build/scene_builder.h"
#include "montelux/scene/render_settings.h"

namespace montelux::gltf {

// A camera of the scene that is shown.
struct PlacedCamera {
    Value camera;
    std::string name; // its own, or that of its node; may be empty
    Placement place;
    Value node;
};

// Sets the camera, and the film's shape where the camera has one. `asked`: a name or a number from 0; empty: the first
// one. Errors: no such camera.
void choose_camera(const std::vector<PlacedCamera>& cameras, const std::optional<std::string>& asked,
                   const Value& root, SceneDescription& description);

// A light of KHR_lights_punctual.
void add_light(const Value& light, const Placement& place, const Value& node, SceneBuilder& builder);

} // namespace montelux::gltf
