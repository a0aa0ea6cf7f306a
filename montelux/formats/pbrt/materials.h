// Materials of a pbrt scene file.
#pragma once

#include <functional>
#include <string>

#include "montelux/formats/pbrt/measured_brdfs.h"
#include "montelux/formats/pbrt/textures.h"

namespace montelux::pbrt {

struct MaterialDeclaration {
    std::string type;
    ParameterList parameters;
    Location at;
    std::string name{}; // of a named material
};

// The index in the scene of a named material, for the directive at a place.
using FindMaterial = std::function<Index(const std::string& name, Location at)>;

// The material with pbrt-v4's defaults for what is not given.
Material make_material(const MaterialDeclaration& d, SceneBuilder& builder, TextureLibrary& textures,
                       MeasuredBrdfLibrary& brdfs, SpectrumReader& spectra, const FindMaterial& find,
                       Diagnostics& diagnostics);

} // namespace montelux::pbrt
