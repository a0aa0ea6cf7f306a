// Subpath: a random path from the camera or from a light, vertex by vertex, to be joined with others.
#pragma once

#include <cmath>
#include <vector>

#include "montelux/mc/random/stream.h"
#include "montelux/scene/camera/camera.h"
#include "montelux/scene/material/make_bsdf.h"
#include "montelux/scene/shape/surface_point.h"

namespace montelux {

// A point of a surface where a subpath scatters.
struct SubpathVertex {
    SurfacePoint s;
    SurfaceBsdf surface;
    SampledSpectrum throughput; // of what arrives here, before it scatters
    SampledWavelengths lambda;  // without the secondary ones from the first dispersive vertex on
    Vec3f w;                    // unit, from the vertex before to this one
    float distance2 = 0;        // to the vertex before, squared
    Vec3f wo;                   // -w in the frame of the BSDF
    float forward = 0;          // density of this point given the vertex before, per area
    // Density of the vertex before given this one and the one after it, per area (of a light at infinity per solid
    // angle): once the subpath has gone on.
    float backward = 0;
    bool delta = false;       // the subpath goes on by a Dirac delta
    bool connectible = false; // scatters by other lobes, too

    // A density of directions to this point (along v, unit, over a squared distance) per solid angle, as one per area.
    float per_area(float pdf, Vec3f v, float squared) const { return pdf * std::abs(dot(s.ng, v)) / squared; }
    // For choosing lights; `local`: on the side that is lit, in the frame of the BSDF.
    ReferencePoint reference(Vec3f local) const {
        ReferencePoint here{s.p, s.ng, s.error, Vec3f{}};
        if (is_opaque(surface.bsdf)) here.facing = local.z > 0 ? surface.frame.n : -surface.frame.n;
        return here;
    }
};

// Adds the surface that a ray of the subpath hits, up to its BSDF.
SubpathVertex& add_vertex(std::vector<SubpathVertex>& path, const SceneView& scene, const Ray& ray,
                          const Hit& hit, SampledSpectrum throughput);
// The BSDF of a vertex, as make_bsdf. Returns false where nothing scatters.
bool make_scattering(const SceneView& scene, const Camera& camera, float footprint_scale, SubpathVertex& v,
                     SampledWavelengths& lambda);

// Veach 1997, section 5.3: the adjoint of a BSDF with shading normals. f |cos theta_i| of the BSDF in the mode of
// importance, times this, is what light brings from wo to wi; both in the frame of the BSDF.
inline float adjoint_correction(const SurfacePoint& s, const Frame& frame, Vec3f wo, Vec3f wi) {
    const float above = std::abs(wo.z * dot(s.ng, frame.to_world(wi))),
                below = std::abs(wi.z * dot(s.ng, frame.to_world(wo)));
    return below > 0 ? above / below : 0;
}

template <RandomStream Stream>
BsdfEvaluation evaluate(const SurfaceBsdf& surface, Vec3f wo, Vec3f wi, TransportMode mode, Stream& stream) {
    return std::visit([&](const BsdfModel auto& bsdf) { return bsdf.evaluate(wo, wi, mode, stream); },
                      surface.bsdf);
}

} // namespace montelux
