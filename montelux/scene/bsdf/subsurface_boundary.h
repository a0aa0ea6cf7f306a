// SubsurfaceBsdf: the boundary of a translucent body, inside which light has lost its direction.
#pragma once

#include <optional>

#include "montelux/mc/warp/hemisphere.h"
#include "montelux/scene/bsdf/bsdf_types.h"
#include "montelux/scene/bsdf/fresnel.h"
#include "montelux/scene/bsdf/ggx.h"

namespace montelux {

// Diffuse Fresnel reflectance of an interface, mean of the Fresnel formula over a cosine-weighted hemisphere of the
// side whose index is 1/eta of the other; eta >= 1. Closed form of Walsh 1926 (Duntley 1942, equation 43).
float diffuse_fresnel_reflectance(float eta);
// The same from the denser side, with total reflection.
inline float internal_diffuse_reflectance(float eta) {
    return 1 - (1 - diffuse_fresnel_reflectance(eta)) / (eta * eta);
}

// From outside (+z): microfacets reflect as those of a dielectric, and the share T(wo) = 1 - F(cos theta) enters with a
// Lambertian distribution. From inside, T(wi) / eta^2 of a Lambertian distribution leaves, and the rest is reflected
// into one. With a smooth surface no light is lost. In contrast to a refracting boundary, lights outside are found by
// light sampling from within. The same assumption is made by separable BSSRDFs (Jensen et al. 2001, "A Practical Model
// for Subsurface Light Transport", S_w).
struct SubsurfaceBsdf {
    float eta = 1.33f;              // index below the surface (-z) over that above, at least 1
    float internal_reflectance = 0; // internal_diffuse_reflectance(eta)
    Ggx ggx;

    static SubsurfaceBsdf make(float eta, Ggx ggx) { return {eta, internal_diffuse_reflectance(eta), ggx}; }

    static constexpr const char* name = "subsurface";
    static constexpr BsdfTraits traits{.transmits = true, .uses_tangents = true};
    template <typename Visit>
    void visit_fields(Visit&& visit) const {
        visit("eta", eta);
        visit("internal reflectance", internal_reflectance);
        visit("surface", ggx);
    }

    bool is_specular() const { return false; }
    bool has_specular() const { return ggx.is_smooth(); }
    bool has_diffuse() const { return true; }
    float transmitted_eta(Vec3f wo) const { return wo.z > 0 ? eta : 1 / eta; }
    SampledSpectrum albedo(Vec3f) const { return SampledSpectrum(1); }

    template <typename Stream>
    BsdfEvaluation evaluate(Vec3f wo, Vec3f wi, TransportMode mode, Stream&) const {
        if (wo.z == 0 || wi.z == 0) return {};
        const float cosine_pdf = inv_pi_f * abs_cos_theta(wi);
        if (!same_hemisphere(wo, wi)) {
            const bool enters = wo.z > 0;
            const float t = transmittance(enters ? wo : wi);
            return {SampledSpectrum(t * cosine_pdf * scale(enters, mode)),
                    (1 - reflection_probability(wo)) * cosine_pdf};
        }
        if (wo.z < 0)
            return {SampledSpectrum(internal_reflectance * cosine_pdf), internal_reflectance * cosine_pdf};
        if (ggx.is_smooth()) return {};
        const Vec3f m = normalize(wo + wi);
        const float density = ggx.visible_pdf(wo, m) / (4 * std::abs(dot(wo, m)));
        return {SampledSpectrum(density * fresnel_dielectric(dot(wo, m), eta) * ggx.g(wo, wi) / ggx.g1(wo)),
                density * reflection_probability(wo)};
    }

    template <typename Stream>
    std::optional<BsdfSample> sample(Vec3f wo, TransportMode mode, Stream& stream) const {
        if (wo.z == 0) return std::nullopt;
        const float uc = stream.next_1d();
        const Vec2f u = stream.next_2d();
        const float p = reflection_probability(wo);
        const bool reflects = uc<p, outside = wo.z> 0;
        BsdfSample s;
        if (reflects && outside) {
            const bool smooth = ggx.is_smooth();
            const Vec3f m = smooth ? Vec3f{0, 0, 1} : ggx.sample_visible(wo, u);
            s.wi = reflect(wo, m);
            if (!same_hemisphere(wo, s.wi)) return std::nullopt;
            s.specular = smooth;
            s.pdf = p;
            s.weight = SampledSpectrum(1);
            if (smooth) return s;
            s.pdf *= ggx.visible_pdf(wo, m) / (4 * std::abs(dot(wo, m)));
            s.weight =
                SampledSpectrum(fresnel_dielectric(dot(wo, m), eta) * ggx.g(wo, s.wi) / (ggx.g1(wo) * p));
            if (!(s.pdf > 0)) return std::nullopt;
            return s;
        }
        s.wi = sample_cosine_hemisphere(u);
        s.pdf = (reflects ? p : 1 - p) * inv_pi_f * s.wi.z;
        if (!(s.pdf > 0)) return std::nullopt;
        s.transmission = !reflects;
        if (outside || reflects) s.wi.z = -s.wi.z;
        if (reflects) {
            s.weight = SampledSpectrum(1);
        } else {
            s.eta = transmitted_eta(wo);
            s.weight = SampledSpectrum(transmittance(outside ? wo : s.wi) * scale(outside, mode) / (1 - p));
        }
        return s;
    }

  private:
    // w is outside.
    float transmittance(Vec3f w) const { return 1 - fresnel_dielectric(w.z, eta); }
    float reflection_probability(Vec3f wo) const {
        return wo.z > 0 ? fresnel_dielectric(wo.z, eta) : internal_reflectance;
    }
    // Of transmission. Radiance is 1 / eta^2 of that inside, importance the other way round.
    float scale(bool wo_is_outside, TransportMode mode) const {
        return wo_is_outside == (mode == TransportMode::radiance) ? 1 / (eta * eta) : 1;
    }
};

} // namespace montelux
