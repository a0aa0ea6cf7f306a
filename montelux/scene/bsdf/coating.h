// CoatedDiffuseBsdf: a diffuse base under a dielectric coat; interreflections are summed in closed form.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "montelux/mc/math/vector_bytes.h"
#include "montelux/mc/warp/hemisphere.h"
#include "montelux/scene/bsdf/dielectric.h"

namespace montelux {

// A Lambertian base does not depend on the incident direction, so the series of bounces under the coat
// factorises:
//   f(wo, wi) = f_coat(wo, wi) + T(wo) T(wi) / (pi eta^2) rho (1 + rho R + ... + (rho R)^(n-1)),
// T(w): the fraction of light from w that reaches the base, R: the fraction of light from the base that the
// coat reflects back. Both include the absorption exp(-thickness / |cos theta|) of each crossing of the
// layer, as in the random walk of Guo et al. 2018 ("Position-Free Monte Carlo Simulation for Arbitrary
// Layered BSDFs"). For isotropic roughness T depends on |cos theta| only and is tabulated; n is the number of
// times that a walk of `max_depth` crossings can reach the base.
class CoatingTable {
  public:
    CoatingTable(float eta, float alpha, float thickness, int max_depth);

    float eta() const { return coat_.eta; }
    const DielectricBsdf& coat() const { return coat_; }
    // T(w) for mu = |cos theta| in [0, 1].
    float transmittance(float mu) const { return interpolate(transmittance_, mu); }
    // Directional albedo of the coat's outer reflection.
    float reflectance(float mu) const { return interpolate(reflectance_, mu); }
    // The mean of T over a cosine-weighted hemisphere.
    float mean_transmittance() const { return mean_transmittance_; }
    // R, for a cosine-weighted distribution from the base.
    float internal_reflectance() const { return internal_reflectance_; }
    // rho (1 + rho R + ...) / eta^2, n terms.
    SampledSpectrum base_albedo(SampledSpectrum rho) const {
        SampledSpectrum x = rho * internal_reflectance_;
        SampledSpectrum power(1);
        SampledSpectrum base = x;
        for (int n = base_visits_; n > 0; n >>= 1) {
            if ((n & 1) != 0) power *= base;
            base *= base;
        }
        return rho * (1.0f - power) / (1.0f - x) * (1 / (coat_.eta * coat_.eta));
    }

    // Memory of the tables.
    std::size_t bytes() const { return vector_bytes(transmittance_, reflectance_); }

  private:
    static float interpolate(const std::vector<float>& table, float mu) {
        float x = std::min(std::max(mu, 0.0f), 1.0f) * static_cast<float>(table.size() - 1);
        auto i = std::min(static_cast<std::size_t>(x), table.size() - 2);
        float t = x - static_cast<float>(i);
        return (1 - t) * table[i] + t * table[i + 1];
    }

    DielectricBsdf coat_;
    int base_visits_;
    std::vector<float> transmittance_, reflectance_;
    float mean_transmittance_ = 0, internal_reflectance_ = 0;
};

// Both sides of the surface are coated: light from below sees the same layers.
struct CoatedDiffuseBsdf {
    const CoatingTable* table = nullptr;
    SampledSpectrum base_albedo; // CoatingTable::base_albedo of the base's reflectance

    static constexpr const char* name = "coated diffuse, closed form";
    static constexpr BsdfTraits traits{};
    template <typename Visit>
    void visit_fields(Visit&& visit) const {
        visit("eta", table->eta());
        visit("coat", table->coat().normals);
        visit("base albedo", base_albedo);
    }

    bool is_specular() const { return false; }
    bool has_specular() const { return table->coat().is_specular(); }
    bool has_diffuse() const { return true; }
    SampledSpectrum albedo(Vec3f wo) const {
        float mu = abs_cos_theta(wo);
        return table->reflectance(mu) +
               base_albedo * (table->transmittance(mu) * table->mean_transmittance());
    }

    template <typename Stream>
    BsdfEvaluation evaluate(Vec3f wo, Vec3f wi, TransportMode mode, Stream&) const {
        if (!same_hemisphere(wo, wi)) return {};
        if (wo.z < 0) {
            wo = -wo;
            wi = -wi;
        }
        Lobe lobe = choose(wo);
        float cosine_pdf = inv_pi_f * wi.z;
        BsdfEvaluation result{base_albedo * (lobe.transmittance * table->transmittance(wi.z) * cosine_pdf),
                              (1 - lobe.p_coat) * cosine_pdf};
        BsdfEvaluation coat = table->coat().evaluate_lobes(wo, wi, mode, Lobes::reflection);
        result.f += coat.f;
        result.pdf += lobe.p_coat * coat.pdf;
        return result;
    }

    template <typename Stream>
    std::optional<BsdfSample> sample(Vec3f wo, TransportMode mode, Stream& stream) const {
        bool below = wo.z < 0;
        if (below) wo = -wo;
        if (wo.z == 0) return std::nullopt;
        Lobe lobe = choose(wo);
        float uc = stream.next_1d();
        Vec2f u = stream.next_2d();
        std::optional<BsdfSample> s;
        const DielectricBsdf& coat = table->coat();
        if (uc < lobe.p_coat) {
            s = coat.sample_lobes(wo, 0, u, mode, Lobes::reflection);
            if (!s) return std::nullopt;
            if (s->specular) {
                s->weight /= lobe.p_coat;
                s->pdf = lobe.p_coat;
            } else {
                float cosine_pdf = inv_pi_f * s->wi.z;
                SampledSpectrum f =
                    s->weight * s->pdf +
                    base_albedo * (lobe.transmittance * table->transmittance(s->wi.z) * cosine_pdf);
                s->pdf = lobe.p_coat * s->pdf + (1 - lobe.p_coat) * cosine_pdf;
                s->weight = f / s->pdf;
            }
        } else {
            Vec3f wi = sample_cosine_hemisphere(u);
            if (!(wi.z > 0)) return std::nullopt;
            float cosine_pdf = inv_pi_f * wi.z;
            BsdfEvaluation top = coat.evaluate_lobes(wo, wi, mode, Lobes::reflection);
            SampledSpectrum f =
                top.f + base_albedo * (lobe.transmittance * table->transmittance(wi.z) * cosine_pdf);
            float pdf = lobe.p_coat * top.pdf + (1 - lobe.p_coat) * cosine_pdf;
            s = BsdfSample{.weight = f / pdf, .wi = wi, .pdf = pdf};
        }
        if (below) s->wi = -s->wi;
        return s;
    }

  private:
    struct Lobe {
        float transmittance; // T(wo)
        float p_coat;        // probability of sampling the coat's reflection
    };
    Lobe choose(Vec3f wo) const {
        float t = table->transmittance(wo.z);
        float coat = table->reflectance(wo.z);
        float base = t * table->mean_transmittance() * average(base_albedo);
        // Neither lobe has probability 0, so the density covers both.
        float p = coat / std::max(coat + base, 1e-9f);
        return {t, std::min(std::max(p, 0.05f), base > 0 ? 0.95f : 1.0f)};
    }
};

} // namespace montelux
