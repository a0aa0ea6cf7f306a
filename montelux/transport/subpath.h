// Subpath: a random path from the camera or from a light, vertex by vertex, to be joined with others.
#pragma once

#include <cmath>
#include <vector>

#include "montelux/mc/random/stream.h"
#include "montelux/scene/light/light_model.h"
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

// Where a path begins at a light: v_0 of PathDensities.
struct LightEnd {
    Index light = no_index;
    LightKind kind = LightKind::surface;
    bool invisible = false; // no ray of the camera hits it
    LightHit hit;           // from the next vertex; of kind position the point alone
    float emission = 0;     // PathDensities::from_light[0]
    float edge = 0;         // density of the emission's other part, for from_light[1]: see edge_density

    bool at_infinity() const { return kind == LightKind::infinite || kind == LightKind::direction; }
    bool is_delta() const { return kind == LightKind::position || kind == LightKind::direction; }
    // from_light[1] at a point with normal n, to which light comes along w (unit) over that squared distance.
    float edge_density(Normal3f n, Vec3f w, float distance2) const {
        const float density = edge * std::abs(dot(n, w));
        return at_infinity() ? density : density / distance2;
    }
    // A density per solid angle of the direction to the light (-w) as one per area of the light.
    float of_light(float pdf, Vec3f w, float distance2) const {
        if (kind != LightKind::surface) return pdf;
        return pdf * std::abs(dot(hit.n, w)) / distance2;
    }
};

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
