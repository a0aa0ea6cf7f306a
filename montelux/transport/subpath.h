// Subpath: a random path from the camera or from a light, vertex by vertex, to be joined with others.
#pragma once

#include <cmath>
#include <vector>

#include "montelux/mc/random/stream.h"
#include "montelux/scene/camera/camera.h"
#include "montelux/scene/material/make_bsdf.h"
#include "montelux/scene/medium/phase_function.h"
#include "montelux/scene/shape/surface_point.h"
#include "montelux/transport/edge_density.h"
#include "montelux/transport/light_choice.h"
#include "montelux/transport/shadow_transmittance.h"

namespace montelux {

// A point of a surface or of a medium where a subpath scatters. In media the frame of the BSDF is that of the world,
// and densities are per volume.
struct SubpathVertex {
    SurfacePoint s; // of a medium: p alone
    SurfaceBsdf surface;
    const PhaseFunction* phase = nullptr; // instead of the BSDF, of a medium
    // Of what arrives here, before it scatters; relative to the density of the first wavelength.
    SampledSpectrum throughput;
    SampledWavelengths lambda; // without the secondary ones from the first dispersive vertex on
    EdgeDensity edge;          // from the vertex before to this one
    Index medium = no_index;   // at the end of that edge
    Vec3f w;                   // unit, from the vertex before to this one
    float distance2 = 0;       // to the vertex before, squared
    Vec3f wo;                  // -w in the frame of the BSDF
    float forward = 0;         // density of this point given the vertex before, per area
    // Density of the vertex before given this one and the one after it, per area (of a light at infinity per solid
    // angle): once the subpath has gone on.
    float backward = 0;
    int events = 0;           // of the subpath, with that of this vertex (IntegratorSettings::count_passages)
    bool delta = false;       // the subpath goes on by a Dirac delta
    bool connectible = false; // scatters by other lobes, too

    // Between a direction of the world and the surface; 1 in media.
    float cosine(Vec3f v) const { return phase != nullptr ? 1 : std::abs(dot(s.ng, v)); }
    // A density of directions to this point (along v, unit, over a squared distance) per solid angle, as one per area.
    float per_area(float pdf, Vec3f v, float squared) const { return pdf * cosine(v) / squared; }
    // For choosing lights; `local`: on the side that is lit, in the frame of the BSDF.
    ReferencePoint reference(Vec3f local) const {
        return phase != nullptr ? ReferencePoint{s.p, {}, 0, Vec3f{}} : reference_point(s, surface, local);
    }
    // What a ray in that direction of the world starts in.
    Index medium_towards(Vec3f v) const { return phase != nullptr ? medium : medium_beyond(s, v, medium); }
    // Veach 1997, section 5.3: the adjoint of a BSDF with shading normals. f |cos theta_i| of the BSDF in the mode of
    // importance, times this, is what light brings from wo to wi, in the frame of the BSDF.
    float adjoint_correction(Vec3f wi) const {
        if (phase != nullptr) return 1;
        const float above = std::abs(wo.z * dot(s.ng, surface.frame.to_world(wi))),
                    below = std::abs(wi.z * dot(s.ng, surface.frame.to_world(wo)));
        return below > 0 ? above / below : 0;
    }
    // Directions are in the frame of the BSDF.
    template <RandomStream Stream>
    BsdfEvaluation evaluate(Vec3f out, Vec3f in, TransportMode mode, Stream& stream) const {
        if (phase == nullptr)
            return std::visit(
                [&](const BsdfModel auto& bsdf) { return bsdf.evaluate(out, in, mode, stream); },
                surface.bsdf);
        const float pdf = std::visit([&](const PhaseModel auto& f) { return f.pdf(out, in); }, *phase);
        return {SampledSpectrum(pdf), pdf};
    }
};

// The end of a subpath that is being extended.
struct SubpathEnd {
    Ray ray; // to be traced next
    SampledWavelengths lambda;
    SampledSpectrum throughput{1}; // as of SubpathVertex
    SampledSpectrum density{1};    // product of EdgeDensity::walked of all edges
    EdgeDensity edge;              // since the last vertex
    Index medium = no_index;       // around the ray
    float distance = 0;            // since the last vertex
    float pdf = 0;                 // of the ray's direction per solid angle; 1 of a delta
    int events = 0;                // scattering events so far
    float eta_scale = 1;           // squared index of refraction, undone for Russian roulette

    // Weighted over the wavelengths by the balance heuristic, as of VolumeState.
    SampledSpectrum carried() const { return throughput / average(density); }
    void take(SampledSpectrum factor) {
        throughput *= factor;
        density *= factor;
        edge.take(factor);
    }
    // Only ratios count: the range of floats must last for many steps.
    void rescale() {
        if (const float largest = max_value(density); largest > 0x1p40f) take(SampledSpectrum(1 / largest));
    }
    // The first wavelength stands for all.
    void terminate_secondary() {
        lambda.lambda = broadcast(lambda.lambda[0]);
        throughput = SampledSpectrum(throughput[0]);
        density = SampledSpectrum(density[0]);
    }
};

// Adds a point of a medium, or the surface that a ray hits, up to its BSDF; the next edge begins.
SubpathVertex& add_vertex(std::vector<SubpathVertex>& path, SubpathEnd& end, Point3f p,
                          const PhaseFunction& phase);
SubpathVertex& add_vertex(std::vector<SubpathVertex>& path, const SceneView& scene, SubpathEnd& end,
                          const Hit& hit);
// The BSDF of a vertex on a surface, as make_bsdf. Returns false where nothing scatters.
bool make_scattering(const SceneView& scene, const Camera& camera, float footprint_scale, SubpathVertex& v,
                     SubpathEnd& end);

} // namespace montelux
