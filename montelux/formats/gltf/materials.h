// MaterialLibrary: the materials of a glTF file, and what else of a shape they decide.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "montelux/formats/gltf/document.h"
#include "montelux/formats/gltf/primitive.h"
#include "montelux/formats/gltf/textures.h"
#include "montelux/scene/build/emission.h"
#include "montelux/scene/build/scene_builder.h"

namespace montelux::gltf {

struct SurfaceLook {
    Index material = no_index;
    FloatParameter alpha{1};
    std::optional<Emission> emission{};
    Index medium_inside = no_index;
    UvSets uv_sets{};
};

// The variants of KHR_materials_variants; may be empty.
std::vector<std::string> variant_names(const Value& root);

class MaterialLibrary {
  public:
    // `variant`: of KHR_materials_variants; an Error if the file does not have it. `pictures`: LoadOptions::pictures.
    MaterialLibrary(Document& document, SceneBuilder& builder, const std::optional<std::string>& variant,
                    bool pictures);

    // That of a primitive, made at the first call. Valid as long as the library.
    const SurfaceLook& of(const Value& primitive);

  private:
    // The index of a material, or none for the default material.
    std::optional<Value> material_of(const Value& primitive) const;
    SurfaceLook make(const std::optional<Value>& source, const VertexColorKinds& vertices);

    Document& document_;
    SceneBuilder& builder_;
    TextureLibrary textures_;
    std::optional<std::uint64_t> variant_;
    std::map<std::pair<std::uint64_t, VertexColorKinds>, SurfaceLook> made_;
};

} // namespace montelux::gltf
