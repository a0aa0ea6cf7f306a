// PlasticBsdf: a diffuse base under a smooth or rough dielectric interface; interreflections in closed form.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "montelux/mc/math/vector_bytes.h"
#include "montelux/mc/warp/hemisphere.h"
#include "montelux/scene/bsdf/dielectric.h"
#include "montelux/scene/bsdf/microfacet_normals.h"

namespace montelux {

// The model of Mitsuba's plugins `plastic` and `roughplastic`: what enters is scattered by a Lambertian base, and
// leaves or returns to it,
//   f(wo, wi) = f_interface(wo, wi) + T(wo) T(wi) / (pi eta^2) rho / (1 - rho R),
// T(w): the fraction of light from w that crosses the interface, R: that of light from the base that the interface
// reflects back. Unless the material is `nonlinear`, the last rho is replaced by 1: colours stay those of the base. No
// light is absorbed between interface and base; for that see CoatingTable.
class PlasticTable {
  public:
    // By quadrature, within 1e-3.
    PlasticTable(float eta, float alpha, MicrofacetDistribution distribution);

    float eta() const { return eta_; }
    // T(w) for mu = |cos theta| in [0, 1].
    float transmittance(float mu) const {
        const float x = std::clamp(mu, 0.0f, 1.0f) * static_cast<float>(transmittance_.size() - 1);
        const std::size_t i = std::min(static_cast<std::size_t>(x), transmittance_.size() - 2);
        const float t = x - static_cast<float>(i);
        return (1 - t) * transmittance_[i] + t * transmittance_[i + 1];
    }
    // The mean of T over a cosine-weighted hemisphere.
    float mean_transmittance() const { return mean_transmittance_; }
    // R, for a cosine-weighted distribution from the base.
    float internal_reflectance() const { return internal_reflectance_; }
    // rho / (eta^2 (1 - rho R)); `reflected_back` is R if it is not 0.
    SampledSpectrum base_albedo(SampledSpectrum rho, bool nonlinear, float reflected_back = 0) const {
        const float r = reflected_back > 0 ? reflected_back : internal_reflectance_;
        const SampledSpectrum returned = r * (nonlinear ? rho : SampledSpectrum(1));
        return rho / ((1.0f - min(returned, SampledSpectrum(0.9999f))) * (eta_ * eta_));
    }

    // Memory of the tables.
    std::size_t bytes() const { return vector_bytes(transmittance_); }

  private:
    float eta_;
    std::vector<float> transmittance_;
    float mean_transmittance_ = 0, internal_reflectance_ = 0;
};

// Both sides of the surface have the interface on their outside.
struct PlasticBsdf {
    const PlasticTable* table = nullptr;
    MicrofacetNormals normals;   // of the interface
    SampledSpectrum base_albedo; // PlasticTable::base_albedo of the base's reflectance
    SampledSpectrum reflected;   // factor of the interface's reflection, 0 to 1

    static constexpr const char* name = "plastic";
    static constexpr BsdfTraits traits{};
    template <typename Visit>
    void visit_fields(Visit&& visit) const {
        visit("eta", table->eta());
        visit("surface", normals);
        visit("base albedo", base_albedo);
        visit("reflected", reflected);
    }

    bool is_specular() const { return false; }
    bool has_specular() const { return interface().is_specular(); }
    bool has_diffuse() const { return true; }
    SampledSpectrum albedo(Vec3f wo) const {
        const float t = table->transmittance(abs_cos_theta(wo));
        return (1 - t) * reflected + t * table->mean_transmittance() * base_albedo;
    }

    template <typename Stream>
    BsdfEvaluation evaluate(Vec3f wo, Vec3f wi, TransportMode, Stream&) const {
        if (!same_hemisphere(wo, wi)) return {};
        return wo.z > 0 ? value(choose(wo), wo, wi) : value(choose(-wo), -wo, -wi);
    }

    template <typename Stream>
    std::optional<BsdfSample> sample(Vec3f wo, TransportMode mode, Stream& stream) const {
        const bool below = wo.z < 0;
        if (below) wo = -wo;
        if (wo.z == 0) return std::nullopt;
        const Lobe lobe = choose(wo);
        const float uc = stream.next_1d();
        const Vec2f u = stream.next_2d();
        BsdfSample s;
        if (uc < lobe.p_interface) {
            const auto mirrored = interface().sample_lobes(wo, 0, u, mode, Lobes::reflection);
            if (!mirrored) return std::nullopt;
            s = *mirrored;
        } else {
            s.wi = sample_cosine_hemisphere(u);
        }
        if (s.specular) {
            s.weight *= reflected / lobe.p_interface;
            s.pdf = lobe.p_interface;
        } else {
            const BsdfEvaluation e = value(lobe, wo, s.wi);
            if (!(e.pdf > 0)) return std::nullopt;
            s.weight = e.f / e.pdf;
            s.pdf = e.pdf;
        }
        if (below) s.wi = -s.wi;
        return s;
    }

  private:
    struct Lobe {
        float transmittance; // T(wo)
        float p_interface;   // probability of sampling the interface's reflection
    };
    DielectricBsdfOf<MicrofacetNormals> interface() const { return {table->eta(), normals}; }

    Lobe choose(Vec3f wo) const {
        const float t = table->transmittance(wo.z);
        const float mirrored = (1 - t) * average(reflected);
        const float base = t * table->mean_transmittance() * average(base_albedo);
        // A lobe that is not black has a probability, so the density covers both.
        const float p = mirrored / std::max(mirrored + base, 1e-9f);
        return {t, std::clamp(p, is_black(reflected) ? 0.0f : 0.05f, is_black(base_albedo) ? 1.0f : 0.95f)};
    }
    // wo and wi above the surface.
    BsdfEvaluation value(const Lobe& lobe, Vec3f wo, Vec3f wi) const {
        const float cosine_pdf = inv_pi_f * wi.z;
        const BsdfEvaluation mirrored =
            interface().evaluate_lobes(wo, wi, TransportMode::radiance, Lobes::reflection);
        return {reflected * mirrored.f +
                    base_albedo * (lobe.transmittance * table->transmittance(wi.z) * cosine_pdf),
                lobe.p_interface * mirrored.pdf + (1 - lobe.p_interface) * cosine_pdf};
    }
};

} // namespace montelux
