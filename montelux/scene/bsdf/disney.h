// DisneyBsdf: the principled models of Disney Animation, of solids and of thin sheets.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "montelux/scene/bsdf/bsdf_list.h"
#include "montelux/scene/bsdf/bsdf_types.h"
#include "montelux/scene/bsdf/microfacet_normals.h"

namespace montelux {

// Burley 2012, "Physically Based Shading at Disney": diffuse reflection that grows or fades at grazing angles with the
// roughness, with a share `flatness` of the fake subsurface scattering of Burley 2015 (after Hanrahan and Krueger 1993),
// and sheen.
struct DisneyBase {
    SampledSpectrum color;       // with its share of the material
    SampledSpectrum sheen_color; // with its weight
    float roughness = 0.5f, flatness = 0;

    // f |cos theta_i|; wo and wi above the surface.
    SampledSpectrum value(Vec3f wo, Vec3f wi) const;
};

// Burley 2015, "Extending the Disney BRDF to a BSDF with Integrated Subsurface Scattering", as Mitsuba's plugin
// `principled` has it: microfacets that reflect as metal and dielectric and, in part, refract; on the outside a diffuse
// base and a clear coat (of the distribution GTR1 and a fixed masking). Lobes are added up without regard to one another:
// light colours at grazing angles reflect more light than they receive.
struct DisneySolid {
    DisneyBase base;
    MicrofacetNormals normals;
    float eta = 1.5f;
    float metallic = 0;
    float transmitting = 0; // share of the dielectric that refracts, times its share of the material
    float tinted = 0;       // share of the dielectric's reflection from outside with tinted_f0
    SampledSpectrum color;  // of metal at normal incidence; light that crosses is multiplied by its root
    SampledSpectrum tinted_f0;
    float coat = 0, coat_alpha = 0.1f;

    bool transmits() const { return transmitting > 0; }
    float transmitted_eta(Vec3f wo) const { return wo.z > 0 ? eta : 1 / eta; }
    SampledSpectrum albedo(Vec3f wo) const;
    BsdfEvaluation evaluate(Vec3f wo, Vec3f wi, TransportMode mode) const;
    std::optional<BsdfSample> sample(Vec3f wo, TransportMode mode, float uc, Vec2f u) const;

  private:
    struct Shares;
    Shares shares(Vec3f wo) const;
    BsdfEvaluation evaluate(const Shares& shares, Vec3f wo, Vec3f wi, TransportMode mode) const;
    SampledSpectrum reflectance(float cos_theta, bool outside) const;
    SampledSpectrum transmittance(float cos_theta) const;
};

// A sheet of the same paper, as Mitsuba's plugin `principledthin`: both sides alike, and without refraction. Light that
// crosses its microfacets spreads with a roughness that depends on the index. That part is not reciprocal: what leaves
// on the near side of the facet that mirrors it is cut off.
struct DisneySheet {
    DisneyBase base;
    MicrofacetNormals reflecting, crossing;
    float eta = 1.5f;
    float clear = 0;       // share that reflects and transmits at microfacets
    float tinted = 0;      // share of their reflection with tinted_f0
    SampledSpectrum color; // factor of light that crosses the microfacets
    SampledSpectrum tinted_f0;
    SampledSpectrum transmitting; // diffuse transmittance

    bool transmits() const { return true; }
    float transmitted_eta(Vec3f) const { return 1; }
    SampledSpectrum albedo(Vec3f wo) const;
    BsdfEvaluation evaluate(Vec3f wo, Vec3f wi, TransportMode mode) const;
    std::optional<BsdfSample> sample(Vec3f wo, TransportMode mode, float uc, Vec2f u) const;

  private:
    struct Shares;
    Shares shares(Vec3f wo) const;
    BsdfEvaluation evaluate(const Shares& shares, Vec3f wo, Vec3f wi) const;
    SampledSpectrum reflectance(float cos_theta) const;
};

// The index of refraction of a parameter: positive, and not 1, where light would not be bent by any microfacet.
inline float disney_index(float eta) {
    if (!(eta > 0)) return 1.001f;
    return std::abs(eta - 1) < 1e-3f ? 1.001f : std::min(eta, 100.0f);
}
// Reflectance at normal incidence.
inline float disney_f0(float eta) {
    const float r = (eta - 1) / (eta + 1);
    return r * r;
}

// `may_transmit` is a property of the type: paths treat an opaque surface differently.
template <typename Lobes, bool may_transmit>
struct DisneyBsdf {
    Lobes lobes;

    static constexpr const char* name = may_transmit ? "Disney's, transmitting" : "Disney's";
    static constexpr BsdfTraits traits{.transmits = may_transmit, .uses_tangents = true};
    template <typename Visit>
    void visit_fields(Visit&& visit) const {
        visit("eta", lobes.eta);
        visit("roughness", lobes.base.roughness);
        visit("flatness", lobes.base.flatness);
        visit("tinted", lobes.tinted);
        visit("base", lobes.base.color);
        visit("sheen", lobes.base.sheen_color);
        visit("color", lobes.color);
        visit("tinted f0", lobes.tinted_f0);
        if constexpr (requires { lobes.coat; }) {
            visit("surface", lobes.normals);
            visit("metallic", lobes.metallic);
            visit("transmitting", lobes.transmitting);
            visit("coat", lobes.coat);
        } else {
            visit("surface", lobes.reflecting);
            visit("clear", lobes.clear);
            visit("diffuse transmission", lobes.transmitting);
        }
    }

    // Rough always.
    bool is_specular() const { return false; }
    bool has_specular() const { return false; }
    bool has_diffuse() const {
        bool crosses = false;
        if constexpr (!requires { lobes.coat; }) crosses = !is_black(lobes.transmitting);
        return crosses || !is_black(lobes.base.color) || !is_black(lobes.base.sheen_color);
    }
    float transmitted_eta(Vec3f wo) const requires may_transmit { return lobes.transmitted_eta(wo); }
    SampledSpectrum albedo(Vec3f wo) const { return lobes.albedo(wo); }

    template <typename Stream>
    BsdfEvaluation evaluate(Vec3f wo, Vec3f wi, TransportMode mode, Stream&) const {
        return lobes.evaluate(wo, wi, mode);
    }
    template <typename Stream>
    std::optional<BsdfSample> sample(Vec3f wo, TransportMode mode, Stream& stream) const {
        const float uc = stream.next_1d();
        const Vec2f u = stream.next_2d();
        return lobes.sample(wo, mode, uc, u);
    }
};

} // namespace montelux
