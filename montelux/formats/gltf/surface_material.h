// make_surface_material: what a glTF material scatters.
#pragma once

#include <string_view>

#include "montelux/formats/gltf/textures.h"
#include "montelux/formats/gltf/value.h"
#include "montelux/scene/material/material.h"

namespace montelux::gltf {

// `base`: its pbrMetallicRoughness. `vertices`: its base colour is multiplied by those of the vertices.
Material make_surface_material(const Value& source, const Value& base, TextureLibrary& textures,
                               SceneBuilder& builder, bool vertices);

// The extension of materials that replaces pbrMetallicRoughness.
inline constexpr std::string_view specular_glossiness = "KHR_materials_pbrSpecularGlossiness";

// The sets of texture coordinates of its textures; the first is that of the picture that emits, or else of the base
// colour's. Warns where they use more than two: the others' textures use the first.
UvSets uv_sets_of(const Value& source);

} // namespace montelux::gltf
