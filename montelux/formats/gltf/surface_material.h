// make_surface_material: what a glTF material scatters.
#pragma once

#include <cstdint>

#include "montelux/formats/gltf/textures.h"
#include "montelux/formats/gltf/value.h"
#include "montelux/scene/material/material.h"

namespace montelux::gltf {

// `base`: its pbrMetallicRoughness. `vertices`: its base colour is multiplied by those of the vertices.
Material make_surface_material(const Value& source, const Value& base, TextureLibrary& textures,
                               SceneBuilder& builder, bool vertices);

// The set of texture coordinates of its textures; warns where they use several, of which the base colour's, or else the
// first one's, is used for all.
std::uint64_t uv_set_of(const Value& source);

} // namespace montelux::gltf
