#include "montelux/scene/material/soft_terminator.h"

#include <algorithm>

#include "montelux/scene/shape/shading_terminator.h"

namespace montelux {

void soften_terminator(const SceneView& scene, const Ray& ray, const Hit& hit, const TextureContext& context,
                       SampledWavelengths& lambda, SurfacePoint& s, SurfaceBsdf& surface, bool widen) {
    if (!is_opaque(surface.bsdf)) return;
    const std::optional<Point3f> raised = raised_position(scene, ray, hit, s);
    if (!raised) return;
    // The bound on the error holds along the facet's normal, and the move adds its rounding.
    s.error *= 1 + 1 / std::max(dot(s.ng, s.ns), 0.1f);
    s.ng = s.ns;
    // A tilted normal is bounded by the geometric one.
    if (std::holds_alternative<TiltedBsdf>(surface.bsdf))
        surface = make_bsdf(scene, s, -ray.d, context, lambda, widen);
    s.p = *raised;
}

} // namespace montelux
