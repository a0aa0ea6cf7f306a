// From a material to the BSDF at a point, with the frame that it lives in.
#pragma once

#include "montelux/scene/bsdf/bsdf.h"
#include "montelux/scene/shape/surface_point.h"
#include "montelux/scene/view.h"

namespace montelux {

struct SurfaceBsdf {
    Bsdf bsdf;
    Frame frame; // its n is the shading normal, with normal map and bumps
};

// `wo`: world space, to the path's vertex before. Where the index of refraction depends on the wavelength, all
// wavelengths but the hero are terminated.
SurfaceBsdf make_bsdf(const SceneView& scene, const SurfacePoint& surface, Vec3f wo,
                      const TextureContext& context, SampledWavelengths& lambda);

} // namespace montelux
