// MaterialLibrary: the BSDFs of a Mitsuba scene as materials, and what else of a shape they decide.
#pragma once

#include <map>
#include <optional>
#include <tuple>

#include "montelux/formats/mitsuba/basic_materials.h"
#include "montelux/formats/mitsuba/plugin.h"
#include "montelux/formats/mitsuba/textures.h"
#include "montelux/scene/build/scene_builder.h"
#include "montelux/scene/material/surface_detail.h"

namespace montelux::mitsuba {

struct SurfaceLook {
    Index material = no_index;
    FloatParameter alpha{1}; // of <bsdf type="mask">
};

class MaterialLibrary {
  public:
    // All must outlive it.
    MaterialLibrary(SceneBuilder& builder, TextureLibrary& textures)
        : builder_(builder), textures_(textures), context_{builder, textures} {}

    // Of an object of the kind bsdf, made at the first call.
    SurfaceLook of(const Plugin& bsdf);
    // Of shapes without one: Mitsuba's grey diffuse surface.
    SurfaceLook standard();

  private:
    // A BSDF that others may contain. Mitsuba's are black from behind if `one_sided`: as long as a "twosided" may stand
    // around it, the material has both sides.
    struct Part {
        Index material = no_index; // none: "null", which lets all light through
        FloatParameter alpha{1};
        bool one_sided = false;
    };

    // `detail`: of the bump and normal maps around it.
    Part part(const Plugin& bsdf, const SurfaceDetail& detail);
    Part make(Plugin bsdf, const SurfaceDetail& detail);
    Part basic(Plugin& bsdf, const SurfaceDetail& detail);
    Part blend(Plugin& bsdf, const SurfaceDetail& detail);
    Part masked(Plugin& bsdf, const SurfaceDetail& detail);
    Part two_sided(Plugin& bsdf, const SurfaceDetail& detail);
    Part bumpy(Plugin& bsdf, SurfaceDetail detail);
    Part normal_mapped(Plugin& bsdf, SurfaceDetail detail);
    // The only BSDF within.
    Part inner(Plugin& bsdf, const SurfaceDetail& detail);

    // Black from behind, if the part is one-sided.
    Index sided(const Part& part);
    Index add(const Material& material, const std::string& name);

    SceneBuilder& builder_;
    TextureLibrary& textures_;
    MaterialContext context_;
    // By Plugin::index, and the texture, map and rules of the detail.
    std::map<std::tuple<std::size_t, Index, Index, bool>, Part> parts_;
    std::map<Index, Index> sided_; // by the material of the front
    Index interface_ = no_index, standard_ = no_index;
};

} // namespace montelux::mitsuba
