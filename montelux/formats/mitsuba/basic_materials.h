// The BSDFs of Mitsuba that contain no others, as materials: a function for each family.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "montelux/formats/mitsuba/plugin.h"
#include "montelux/formats/mitsuba/textures.h"
#include "montelux/scene/build/scene_builder.h"
#include "montelux/scene/material/material.h"

namespace montelux::mitsuba {

struct BasicMaterial {
    Material material;
    bool one_sided = false; // black from behind in Mitsuba, unless it is within a "twosided"
};

// What the functions need beside the plugin. Both must outlive it.
struct MaterialContext {
    SceneBuilder& builder;
    TextureLibrary& textures;
    std::map<std::string, Index> measured_brdfs{}; // by path
};

// Each is empty for plugins of other families. All properties are read or reported.
std::optional<BasicMaterial> read_conductor(Plugin& bsdf, MaterialContext& context);
std::optional<BasicMaterial> read_dielectric(Plugin& bsdf, MaterialContext& context);
std::optional<BasicMaterial> read_diffuse_base(Plugin& bsdf, MaterialContext& context); // diffuse, plastics
std::optional<BasicMaterial> read_principled(Plugin& bsdf, MaterialContext& context);
std::optional<BasicMaterial> read_measured(Plugin& bsdf, MaterialContext& context); // and hair

// Parts of several families: `alpha`, or `alpha_u` and `alpha_v`; and their distribution, "beckmann" by default.
RoughnessParameter read_roughness(Plugin& bsdf, MaterialContext& context);
MicrofacetDistribution read_distribution(Plugin& bsdf);

} // namespace montelux::mitsuba
