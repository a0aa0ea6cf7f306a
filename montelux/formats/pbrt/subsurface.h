// The interior of the material 'subsurface' of a pbrt scene file.
#pragma once

#include "montelux/formats/pbrt/parameter_reader.h"
#include "montelux/formats/pbrt/spectrum_parameter.h"
#include "montelux/formats/pbrt/textures.h"
#include "montelux/scene/build/scene_builder.h"

namespace montelux::pbrt {

// Of `name`, or sigma_a and sigma_s, or reflectance and mfp, with pbrt-v4's defaults. `eta` is that of the surface.
HomogeneousMedium read_subsurface(ParameterReader& r, SceneBuilder& builder, SpectrumReader& spectra,
                                  TextureLibrary& textures, float eta);

} // namespace montelux::pbrt
