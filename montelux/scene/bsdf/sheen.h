// Sheen: reflection by upright fibres, as of velvet.
#pragma once

#include <algorithm>

#include "montelux/scene/bsdf/bsdf_types.h"

namespace montelux {

// "Charlie" of Conty and Kulla 2017, "Production Friendly Microfacet Sheen BRDF", in the form of glTF's
// KHR_materials_sheen: no Fresnel term. At grazing angles it reflects more light than it receives when the fibres
// are narrow; there it is divided by the larger of both directions' albedos, which keeps it reciprocal.
struct Sheen {
    // Of the distribution, at least least_roughness squared: sharper sheens are seen at grazing angles only.
    float alpha = 0.25f;

    static constexpr float least_roughness = 0.1f; // the square root of alpha
    static Sheen from_roughness(float roughness) {
        const float r = std::max(roughness, least_roughness);
        return {r * r};
    }

    // Value times cosine of wi for white fibres, 1/sr; wo and wi in the same hemisphere.
    float value(Vec3f wo, Vec3f wi) const;

    // An upper bound of the directional albedo, at most 1 and at most 0.04 above it.
    float albedo(Vec3f w) const { return std::min(charlie_albedo(abs_cos_theta(w)), 1.0f); }

  private:
    float charlie_albedo(float cos_theta) const;
    float lambda(float cos_theta) const;
};

} // namespace montelux
