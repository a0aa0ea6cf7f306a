// DiffuseBsdf: Lambertian reflection.
#pragma once

#include "montelux/mc/warp/hemisphere.h"
#include "montelux/scene/bsdf/bsdf_list.h"
#include "montelux/scene/bsdf/bsdf_types.h"

namespace montelux {

template <Number T>
struct DiffuseBsdfOf {
    SpectrumOf<T> reflectance;

    static constexpr const char* name = "diffuse";
    static constexpr BsdfTraits traits{};
    template <typename Visit>
    void visit_fields(Visit&& visit) const {
        visit("reflectance", reflectance);
    }

    bool is_specular() const { return false; }
    bool has_specular() const { return false; }
    bool has_diffuse() const { return true; }
    SpectrumOf<T> albedo(Vec3<T>) const { return reflectance; }

    template <typename Stream>
    BsdfEvaluationOf<T> evaluate(Vec3<T> wo, Vec3<T> wi, TransportMode, Stream&) const {
        const T pdf = select(same_hemisphere(wo, wi), inv_pi_f * abs_cos_theta(wi), T(0));
        return {reflectance * pdf, pdf};
    }

    template <typename Stream>
    auto sample(Vec3<T> wo, TransportMode, Stream& stream) const {
        Vec3<T> wi = sample_cosine_hemisphere<T>(stream.next_2d());
        wi.z = select(wo.z < 0, -wi.z, wi.z);
        const T pdf = inv_pi_f * abs_cos_theta(wi);
        return sample_if(pdf > 0, BsdfSampleOf<T>{.weight = reflectance, .wi = wi, .pdf = pdf});
    }
};

} // namespace montelux
