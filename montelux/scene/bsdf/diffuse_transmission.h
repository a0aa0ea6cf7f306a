// DiffuseTransmissionBsdf: Lambertian reflection and Lambertian transmission; leaves, paper, cloth.
#pragma once

#include <optional>

#include "montelux/mc/warp/hemisphere.h"
#include "montelux/scene/bsdf/bsdf_types.h"

namespace montelux {

// f = reflectance / pi on the side of wo and transmittance / pi on the other, as pbrt-v4's
// DiffuseTransmissionBxDF. The side is chosen in proportion to the largest component of each.
struct DiffuseTransmissionBsdf {
    SampledSpectrum reflectance, transmittance;

    static constexpr const char* name = "diffuse transmission";
    static constexpr BsdfTraits traits{.transmits = true};
    template <typename Visit>
    void visit_fields(Visit&& visit) const {
        visit("reflectance", reflectance);
        visit("transmittance", transmittance);
    }

    bool is_specular() const { return false; }
    bool has_specular() const { return false; }
    bool has_diffuse() const { return true; }
    float transmitted_eta(Vec3f) const { return 1; }
    SampledSpectrum albedo(Vec3f) const { return reflectance + transmittance; }

    template <typename Stream>
    BsdfEvaluation evaluate(Vec3f wo, Vec3f wi, TransportMode, Stream&) const {
        if (wo.z == 0 || wi.z == 0) return {};
        const bool reflects = same_hemisphere(wo, wi);
        const float p = reflection_probability();
        const float cosine_pdf = inv_pi_f * abs_cos_theta(wi);
        return {(reflects ? reflectance : transmittance) * cosine_pdf, (reflects ? p : 1 - p) * cosine_pdf};
    }

    template <typename Stream>
    std::optional<BsdfSample> sample(Vec3f wo, TransportMode, Stream& stream) const {
        if (wo.z == 0) return std::nullopt;
        const float uc = stream.next_1d();
        const Vec2f u = stream.next_2d();
        const float p = reflection_probability();
        const bool reflects = uc < p;
        const float chosen = reflects ? p : 1 - p;
        Vec3f wi = sample_cosine_hemisphere(u);
        const float pdf = chosen * inv_pi_f * abs_cos_theta(wi);
        if (!(pdf > 0)) return std::nullopt;
        if ((wo.z > 0) != reflects) wi.z = -wi.z;
        return BsdfSample{.weight = (reflects ? reflectance : transmittance) / chosen,
                          .wi = wi,
                          .pdf = pdf,
                          .transmission = !reflects};
    }

  private:
    float reflection_probability() const {
        const float r = max_value(reflectance), t = max_value(transmittance);
        return r + t > 0 ? r / (r + t) : 1;
    }
};

} // namespace montelux
