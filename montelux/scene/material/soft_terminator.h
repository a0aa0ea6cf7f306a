// soften_terminator: light for a coarse mesh is gathered as if the mesh were as smooth as its normals.
#pragma once

#include "montelux/scene/material/make_bsdf.h"

namespace montelux {

// For opaque BSDFs: moves s to raised_position (scene/shape/shading_terminator.h) and makes the shading normal its
// geometric one, for rays that leave and for tilted normals. `surface` is the BSDF of s, made with `widen`. The BSDF
// stays what it is, so scattering absorbs no more than before, and light sampling and paths start at the same point.
void soften_terminator(const SceneView& scene, const Ray& ray, const Hit& hit, const TextureContext& context,
                       SampledWavelengths& lambda, SurfacePoint& s, SurfaceBsdf& surface, bool widen);

} // namespace montelux
