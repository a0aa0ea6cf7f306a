// DiffuseBsdf: Lambertian reflection.
#pragma once

#include <optional>

#include "montelux/mc/warp/hemisphere.h"
#include "montelux/scene/bsdf/bsdf_types.h"

namespace montelux {

struct DiffuseBsdf {
    SampledSpectrum reflectance;

    static constexpr const char* name = "diffuse";
    static constexpr BsdfTraits traits{};
    template <typename Visit>
    void visit_fields(Visit&& visit) const {
        visit("reflectance", reflectance);
    }

    bool is_specular() const { return false; }
    bool has_specular() const { return false; }
    SampledSpectrum albedo(Vec3f) const { return reflectance; }

    template <typename Stream>
    BsdfEvaluation evaluate(Vec3f wo, Vec3f wi, TransportMode, Stream&) const {
        if (!same_hemisphere(wo, wi)) return {};
        float pdf = inv_pi_f * abs_cos_theta(wi);
        return {reflectance * pdf, pdf};
    }

    template <typename Stream>
    std::optional<BsdfSample> sample(Vec3f wo, TransportMode, Stream& stream) const {
        Vec2f u = stream.next_2d();
        Vec3f wi = sample_cosine_hemisphere(u);
        if (wo.z < 0) wi.z = -wi.z;
        float pdf = inv_pi_f * abs_cos_theta(wi);
        if (!(pdf > 0)) return std::nullopt;
        return BsdfSample{.weight = reflectance, .wi = wi, .pdf = pdf};
    }
};

} // namespace montelux
