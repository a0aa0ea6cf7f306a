// MaterialLibrary: the BSDFs of a Mitsuba scene as materials, and what else of a shape they decide.
#pragma once

#include <map>

#include "montelux/formats/mitsuba/plugin.h"
#include "montelux/formats/mitsuba/textures.h"
#include "montelux/scene/build/scene_builder.h"

namespace montelux::mitsuba {

struct SurfaceLook {
    Index material = no_index;
    FloatParameter alpha{1}; // of <bsdf type="mask">
};

class MaterialLibrary {
  public:
    // All must outlive it.
    MaterialLibrary(SceneBuilder& builder, TextureLibrary& textures)
        : builder_(builder), textures_(textures) {}

    // Of an object of the kind bsdf, made at the first call.
    SurfaceLook of(const Plugin& bsdf);
    // Of shapes without one: Mitsuba's grey diffuse surface.
    SurfaceLook standard();

  private:
    SurfaceLook make(Plugin bsdf);

    SceneBuilder& builder_;
    TextureLibrary& textures_;
    std::map<std::size_t, SurfaceLook> made_; // by Plugin::index
};

} // namespace montelux::mitsuba
