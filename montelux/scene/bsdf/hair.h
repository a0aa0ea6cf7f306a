// HairBsdf: scattering by a hair, a rough dielectric cylinder with tilted scales and an absorbing interior.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "montelux/mc/math/constants.h"
#include "montelux/scene/bsdf/bsdf_types.h"
#include "montelux/scene/bsdf/fresnel.h"

namespace montelux {

// Chiang, Bitterli, Tappan, Burley 2016, "A Practical and Controllable Hair and Fur Model for Production Path
// Tracing". The hair runs along x. Lobes: reflection (R), transmission (TT), one internal reflection (TRT), and
// all further ones together. theta is the angle to the plane across the hair, phi the one about it.
struct HairBsdf {
    static constexpr int lobes = 4;

    float h = 0; // offset across the hair, -1 to 1 along +y
    float eta = 1.55f;
    SampledSpectrum sigma_a; // per radius of the hair
    float variance = 0;      // of R in theta is v; of TT v / 4, of the others 4 v
    float scale = 0;         // of the logistic distribution in phi
    float sin_tilt = 0;      // of the scales
    float cos_tilt = 1;

    // Roughness beta_m along and beta_n about the hair, 0 to 1; `tilt` of the scales in degrees.
    static HairBsdf make(float h, float eta, SampledSpectrum sigma_a, float beta_m, float beta_n, float tilt);
    // Absorption that gives a reflectance of many hairs (equation 9).
    static SampledSpectrum sigma_a_of_reflectance(SampledSpectrum reflectance, float beta_n);

    static constexpr const char* name = "hair";
    static constexpr BsdfTraits traits{.transmits = true, .uses_tangents = true};
    template <typename Visit>
    void visit_fields(Visit&& visit) const {
        visit("h", h);
        visit("eta", eta);
        visit("sigma_a", sigma_a);
        visit("variance", variance);
        visit("scale", scale);
        visit("sine of tilt", sin_tilt);
        visit("cosine of tilt", cos_tilt);
    }

    bool is_specular() const { return false; }
    bool has_specular() const { return false; }
    bool has_diffuse() const { return false; }
    float transmitted_eta(Vec3f) const { return 1; } // paths enter and leave the hair within it
    SampledSpectrum albedo(Vec3f wo) const;

    template <typename Stream>
    BsdfEvaluation evaluate(Vec3f wo, Vec3f wi, TransportMode, Stream&) const {
        return evaluate(wo, wi);
    }
    template <typename Stream>
    std::optional<BsdfSample> sample(Vec3f wo, TransportMode, Stream& stream) const {
        const float uc = stream.next_1d();
        return sample(wo, uc, stream.next_2d());
    }

    // Factors of the model, for tests.
    // Longitudinal scattering: a density in theta_i with the measure cos(theta_i) d theta_i (d'Eon et al. 2011,
    // "An Energy-Conserving Hair Reflectance Model", equation 7).
    static float longitudinal(float sin_i, float cos_i, float sin_o, float cos_o, float v);
    // A logistic distribution on [-pi, pi].
    static float azimuthal(float dphi, float scale);
    // Share of the light in each lobe (section 3.3 of Chiang et al.); they sum to 1 without absorption.
    std::array<SampledSpectrum, lobes> attenuation(float sin_o, float cos_o) const;

  private:
    struct Outgoing;

    BsdfEvaluation evaluate(Vec3f wo, Vec3f wi) const;
    BsdfEvaluation evaluate(const Outgoing& o, float sin_i, float cos_i, float phi) const;
    std::optional<BsdfSample> sample(Vec3f wo, float uc, Vec2f u) const;
};

} // namespace montelux
