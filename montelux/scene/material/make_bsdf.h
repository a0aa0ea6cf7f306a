// From a material to the BSDF at a point.
#pragma once

#include "montelux/scene/bsdf/bsdf.h"
#include "montelux/scene/view.h"

namespace montelux {

// Where the index of refraction depends on the wavelength, all wavelengths but the hero are terminated.
Bsdf make_bsdf(const SceneView& scene, Index material, const TextureContext& context,
               SampledWavelengths& lambda);

// Whether the BSDF's lobes depend on the direction of the tangents.
bool is_anisotropic(const Material& material);

} // namespace montelux
