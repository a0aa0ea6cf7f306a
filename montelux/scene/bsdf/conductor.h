// Metals: a mirror or microfacets with the Fresnel reflectance of a complex index of refraction.
#pragma once

#include <optional>

#include "montelux/scene/bsdf/bsdf_list.h"
#include "montelux/scene/bsdf/bsdf_types.h"
#include "montelux/scene/bsdf/fresnel.h"
#include "montelux/scene/bsdf/ggx.h"

namespace montelux {

// Normals: a distribution of microfacet normals, Ggx or MicrofacetNormals.
template <typename Normals>
struct ConductorBsdfOf {
    SampledSpectrum eta, k;
    Normals normals;

    static constexpr const char* name = "conductor";
    static constexpr BsdfTraits traits{.uses_tangents = true};
    template <typename Visit>
    void visit_fields(Visit&& visit) const {
        visit("surface", normals);
        visit("eta", eta);
        visit("k", k);
    }

    bool is_specular() const { return normals.is_smooth(); }
    bool has_specular() const { return is_specular(); }
    bool has_diffuse() const { return false; }
    SampledSpectrum albedo(Vec3f wo) const { return fresnel_conductor(abs_cos_theta(wo), eta, k); }

    template <typename Stream>
    BsdfEvaluation evaluate(Vec3f wo, Vec3f wi, TransportMode, Stream&) const {
        if (normals.is_smooth() || !same_hemisphere(wo, wi)) return {};
        Vec3f m = wo + wi;
        float len2 = length_squared(m);
        if (!(len2 > 0)) return {};
        m = m / std::sqrt(len2);
        const InverseMasking masking = normals.inverse_masking(wo, wi);
        float d_over_4cos = normals.d(m) / (4 * abs_cos_theta(wo));
        SampledSpectrum fresnel = fresnel_conductor(abs_dot(wo, m), eta, k);
        return {fresnel * (d_over_4cos / masking.both), d_over_4cos / masking.visible};
    }

    template <typename Stream>
    std::optional<BsdfSample> sample(Vec3f wo, TransportMode, Stream& stream) const {
        if (wo.z == 0) return std::nullopt;
        if (normals.is_smooth()) {
            Vec3f wi{-wo.x, -wo.y, wo.z};
            SampledSpectrum fresnel = fresnel_conductor(abs_cos_theta(wo), eta, k);
            return BsdfSample{.weight = fresnel, .wi = wi, .pdf = 1, .specular = true};
        }
        Vec2f u = stream.next_2d();
        Vec3f m = normals.sample_visible(wo, u);
        Vec3f wi = reflect(wo, wo.z < 0 ? -m : m);
        if (!same_hemisphere(wo, wi)) return std::nullopt;
        const InverseMasking masking = normals.inverse_masking(wo, wi);
        float pdf = normals.d(m) / (4 * abs_cos_theta(wo) * masking.visible);
        SampledSpectrum fresnel = fresnel_conductor(abs_dot(wo, m), eta, k);
        return BsdfSample{.weight = fresnel * (masking.visible / masking.both), .wi = wi, .pdf = pdf};
    }
};

} // namespace montelux
