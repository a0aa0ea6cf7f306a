// Metals: a mirror or GGX microfacets with the Fresnel reflectance of a complex index of refraction.
#pragma once

#include <optional>

#include "montelux/scene/bsdf/bsdf_types.h"
#include "montelux/scene/bsdf/fresnel.h"
#include "montelux/scene/bsdf/ggx.h"

namespace montelux {

struct ConductorBsdf {
    SampledSpectrum eta, k;
    Ggx ggx;

    static constexpr const char* name = "conductor";
    static constexpr BsdfTraits traits{.uses_tangents = true};
    template <typename Visit>
    void visit_fields(Visit&& visit) const {
        visit("surface", ggx);
        visit("eta", eta);
        visit("k", k);
    }

    bool is_specular() const { return ggx.is_smooth(); }
    bool has_specular() const { return is_specular(); }
    SampledSpectrum albedo(Vec3f wo) const { return fresnel_conductor(abs_cos_theta(wo), eta, k); }

    template <typename Stream>
    BsdfEvaluation evaluate(Vec3f wo, Vec3f wi, TransportMode, Stream&) const {
        if (ggx.is_smooth() || !same_hemisphere(wo, wi)) return {};
        Vec3f m = wo + wi;
        float len2 = length_squared(m);
        if (!(len2 > 0)) return {};
        m = m / std::sqrt(len2);
        float lambda_o = ggx.lambda(wo);
        float d_over_4cos = ggx.d(m) / (4 * abs_cos_theta(wo));
        SampledSpectrum fresnel = fresnel_conductor(abs_dot(wo, m), eta, k);
        return {fresnel * (d_over_4cos / (1 + lambda_o + ggx.lambda(wi))), d_over_4cos / (1 + lambda_o)};
    }

    template <typename Stream>
    std::optional<BsdfSample> sample(Vec3f wo, TransportMode, Stream& stream) const {
        if (wo.z == 0) return std::nullopt;
        if (ggx.is_smooth()) {
            Vec3f wi{-wo.x, -wo.y, wo.z};
            SampledSpectrum fresnel = fresnel_conductor(abs_cos_theta(wo), eta, k);
            return BsdfSample{.weight = fresnel, .wi = wi, .pdf = 1, .specular = true};
        }
        Vec2f u = stream.next_2d();
        Vec3f m = ggx.sample_visible(wo, u);
        Vec3f wi = reflect(wo, wo.z < 0 ? -m : m);
        if (!same_hemisphere(wo, wi)) return std::nullopt;
        float lambda_o = ggx.lambda(wo);
        float pdf = ggx.d(m) / (4 * abs_cos_theta(wo) * (1 + lambda_o));
        SampledSpectrum fresnel = fresnel_conductor(abs_dot(wo, m), eta, k);
        float masking = (1 + lambda_o) / (1 + lambda_o + ggx.lambda(wi));
        return BsdfSample{.weight = fresnel * masking, .wi = wi, .pdf = pdf};
    }
};

} // namespace montelux
