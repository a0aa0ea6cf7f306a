// Materials of a pbrt scene file.
#pragma once

#include <string>

#include "montelux/formats/pbrt/textures.h"

namespace montelux::pbrt {

struct MaterialDeclaration {
    std::string type;
    ParameterList parameters;
    Location at;
};

// False for a material of pbrt that Montelux does not have yet; an error for one that pbrt does not have.
bool is_supported_material(const MaterialDeclaration& d, Diagnostics& diagnostics);

// The material with pbrt-v4's defaults for what is not given.
Material make_material(const MaterialDeclaration& d, TextureLibrary& textures, SpectrumReader& spectra,
                       Diagnostics& diagnostics);

} // namespace montelux::pbrt
