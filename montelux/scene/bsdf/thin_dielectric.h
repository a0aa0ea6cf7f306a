// A thin clear slab: light goes straight through or is mirrored, all internal reflections summed.
#pragma once

#include <optional>

#include "montelux/scene/bsdf/bsdf_types.h"
#include "montelux/scene/bsdf/fresnel.h"

namespace montelux {

struct ThinDielectricBsdf {
    float eta = 1.5f;

    static constexpr const char* name = "thin dielectric";
    static constexpr BsdfTraits traits{.transmits = true};
    template <typename Visit>
    void visit_fields(Visit&& visit) const {
        visit("eta", eta);
    }

    bool is_specular() const { return true; }
    bool has_specular() const { return true; }
    bool has_diffuse() const { return false; }
    float transmitted_eta(Vec3f) const { return 1; }
    SampledSpectrum albedo(Vec3f) const { return SampledSpectrum(1); }
    // The geometric series of bounces inside the slab (Stokes): R + T R T + T R R R T + ...
    float reflectance(Vec3f wo) const {
        float r = fresnel_dielectric(abs_cos_theta(wo), eta);
        if (r < 1) r += (1 - r) * (1 - r) * r / (1 - r * r);
        return r;
    }

    template <typename Stream>
    BsdfEvaluation evaluate(Vec3f, Vec3f, TransportMode, Stream&) const {
        return {};
    }

    template <typename Stream>
    std::optional<BsdfSample> sample(Vec3f wo, TransportMode, Stream& stream) const {
        const float r = reflectance(wo);
        float uc = stream.next_1d();
        if (uc < r)
            return BsdfSample{
                .weight = SampledSpectrum(1), .wi = {-wo.x, -wo.y, wo.z}, .pdf = r, .specular = true};
        return BsdfSample{
            .weight = SampledSpectrum(1), .wi = -wo, .pdf = 1 - r, .specular = true, .transmission = true};
    }
};

} // namespace montelux
