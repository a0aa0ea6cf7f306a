// TiltedBsdf: a BSDF with a shading normal tilted by a map or bumps; no light leaks through the surface.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "montelux/scene/bsdf/untilted_bsdf.h"

namespace montelux {

// The base in the frame of the tilted normal, zero for directions above the plane of one normal but below
// that of the other (Veach 1997, section 5.3). With `shadowing` it is multiplied by the masking of the light's
// direction by microfacets of that roughness around the other normal: 2 / (1 + sqrt(1 + alpha^2 tan^2 theta))
// (Estevez, Lecocq, Stein 2019).
struct TiltedBsdf {
    UntiltedBsdf base;
    Normal3f geometric_normal; // in the local frame, on the side of +z
    float shadowing = 0;       // alpha^2; 0: none

    static constexpr const char* name = "by a tilted normal";
    // Those of any base.
    static constexpr BsdfTraits traits{.transmits = true, .uses_tangents = true, .stochastic = true};
    template <typename Visit>
    void visit_fields(Visit&& visit) const {
        std::visit([&](const auto& b) { visit("BSDF", b); }, base);
    }

    bool is_specular() const;
    bool has_specular() const;
    bool has_diffuse() const;
    float transmitted_eta(Vec3f wo) const;
    SampledSpectrum albedo(Vec3f wo) const;

    template <typename Stream>
    BsdfEvaluation evaluate(Vec3f wo, Vec3f wi, TransportMode mode, Stream& stream) const {
        return evaluate(wo, wi, mode, is_stochastic() ? stream.next_2d() : Vec2f{});
    }
    template <typename Stream>
    std::optional<BsdfSample> sample(Vec3f wo, TransportMode mode, Stream& stream) const {
        const float uc = stream.next_1d();
        const Vec2f u = stream.next_2d();
        return sample(wo, mode, uc, u);
    }

  private:
    // Compiled separately: untilted BSDFs keep their code, and so their speed and bits.
    BsdfEvaluation evaluate(Vec3f wo, Vec3f wi, TransportMode mode, Vec2f u) const;
    std::optional<BsdfSample> sample(Vec3f wo, TransportMode mode, float uc, Vec2f u) const;
    bool is_stochastic() const;
    bool keeps_side(Vec3f w) const { return w.z * dot(geometric_normal, w) > 0; }
    float unshadowed(Vec3f wi) const {
        const float mu = dot(geometric_normal, wi), cos2 = mu * mu;
        return 2 / (1 + std::sqrt(1 + shadowing * std::max(1 - cos2, 0.0f) / cos2));
    }
};

} // namespace montelux
