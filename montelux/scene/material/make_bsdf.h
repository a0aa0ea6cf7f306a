// make_bsdf: the BSDF of a material at a point, with its frame.
#pragma once

#include "montelux/scene/bsdf/bsdf.h"
#include "montelux/scene/shape/surface_point.h"
#include "montelux/scene/view.h"

namespace montelux {

struct SurfaceBsdf {
    Bsdf bsdf;
    Frame frame; // its n is the shading normal, with bumps and normal map
};

// `wo`: world space, towards the previous vertex of the path. If the index of refraction depends on the
// wavelength, all wavelengths but the hero are terminated. `widen`: of IntegratorSettings::regularize.
SurfaceBsdf make_bsdf(const SceneView& scene, const SurfacePoint& surface, Vec3f wo,
                      const TextureContext& context, SampledWavelengths& lambda, bool widen = false);

} // namespace montelux
