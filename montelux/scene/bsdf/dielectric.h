// Glass and other clear interfaces: smooth, or microfacets that reflect and refract.
#pragma once

#include <optional>

#include "montelux/scene/bsdf/bsdf_list.h"
#include "montelux/scene/bsdf/bsdf_types.h"
#include "montelux/scene/bsdf/fresnel.h"
#include "montelux/scene/bsdf/ggx.h"
#include "montelux/scene/bsdf/microfacet_pair.h"

namespace montelux {

// Which lobes take part: walks through layers ask for one of them.
enum class Lobes : std::uint8_t { both, reflection, transmission };

// Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces". Normals as of ConductorBsdfOf.
template <typename Normals>
struct DielectricBsdfOf {
    float eta = 1.5f; // index below the surface (-z) over that above
    Normals normals;

    static constexpr const char* name = "dielectric";
    static constexpr BsdfTraits traits{.transmits = true, .uses_tangents = true};
    template <typename Visit>
    void visit_fields(Visit&& visit) const {
        visit("eta", eta);
        visit("surface", normals);
    }

    // An index of 1 bends nothing, however rough the interface.
    bool is_specular() const { return eta == 1 || normals.is_smooth(); }
    bool has_specular() const { return is_specular(); }
    bool has_diffuse() const { return false; }
    float transmitted_eta(Vec3f wo) const { return wo.z > 0 ? eta : 1 / eta; }
    SampledSpectrum albedo(Vec3f) const { return SampledSpectrum(1); }
    // Of a smooth interface.
    float reflectance(Vec3f wo) const { return fresnel_dielectric(wo.z, eta); }

    template <typename Stream>
    BsdfEvaluation evaluate(Vec3f wo, Vec3f wi, TransportMode mode, Stream&) const {
        return evaluate_lobes(wo, wi, mode, Lobes::both);
    }
    template <typename Stream>
    std::optional<BsdfSample> sample(Vec3f wo, TransportMode mode, Stream& stream) const {
        float uc = stream.next_1d();
        Vec2f u = is_specular() ? Vec2f{} : stream.next_2d();
        return sample_lobes(wo, uc, u, mode, Lobes::both);
    }

    BsdfEvaluation evaluate_lobes(Vec3f wo, Vec3f wi, TransportMode mode, Lobes lobes) const {
        if (is_specular() || wo.z == 0 || wi.z == 0) return {};
        bool reflects = same_hemisphere(wo, wi);
        if (lobes != Lobes::both && reflects != (lobes == Lobes::reflection)) return {};
        float eta_p = reflects ? 1 : (wo.z > 0 ? eta : 1 / eta);
        const auto facet = MicrofacetPair::find(normals, wo, wi, reflects, eta_p);
        if (!facet) return {};
        const float r = fresnel_dielectric(facet->o_m, eta);
        const float fresnel = reflects ? r : 1 - r;
        const float chosen = lobes == Lobes::both ? fresnel : 1;
        float f = facet->density * fresnel * facet->shadowing;
        if (!reflects && mode == TransportMode::radiance) f /= eta_p * eta_p;
        return {SampledSpectrum(f), facet->density * chosen};
    }

    // uc chooses between reflection and refraction, u the microfacet.
    std::optional<BsdfSample> sample_lobes(Vec3f wo, float uc, Vec2f u, TransportMode mode,
                                           Lobes lobes) const {
        if (wo.z == 0) return std::nullopt;
        bool smooth = is_specular();
        Vec3f m = smooth ? Vec3f{0, 0, 1} : normals.sample_visible(wo, u);
        float r = fresnel_dielectric(dot(wo, m), eta);
        float p_reflect = lobes == Lobes::both ? r : (lobes == Lobes::reflection ? 1.0f : 0.0f);
        bool reflects = uc < p_reflect;
        float chosen = reflects ? p_reflect : 1 - p_reflect;
        float fresnel = reflects ? r : 1 - r;
        BsdfSample s;
        s.specular = smooth;
        s.transmission = !reflects;
        if (reflects) {
            s.wi = smooth ? Vec3f{-wo.x, -wo.y, wo.z} : reflect(wo, m);
            if (!same_hemisphere(wo, s.wi)) return std::nullopt;
        } else {
            auto refraction = refract(wo, m, eta);
            if (!refraction || same_hemisphere(wo, refraction->wt) || refraction->wt.z == 0)
                return std::nullopt;
            s.wi = refraction->wt;
            s.eta = refraction->eta;
        }
        float weight = fresnel / chosen;
        if (!reflects && mode == TransportMode::radiance) weight /= s.eta * s.eta;
        if (smooth) {
            s.pdf = chosen;
            s.weight = SampledSpectrum(weight);
            return s;
        }
        float o_m = dot(wo, m), i_m = dot(s.wi, m);
        const InverseMasking masking = normals.inverse_masking(wo, s.wi);
        float visible = normals.d(m) * std::abs(o_m) / (masking.visible * std::abs(wo.z));
        float denominator = i_m + o_m / s.eta;
        float jacobian = reflects ? 1 / (4 * std::abs(o_m)) : std::abs(i_m) / (denominator * denominator);
        s.pdf = visible * jacobian * chosen;
        s.weight = SampledSpectrum(weight * masking.visible / masking.both);
        if (!(s.pdf > 0)) return std::nullopt;
        return s;
    }
};

} // namespace montelux
