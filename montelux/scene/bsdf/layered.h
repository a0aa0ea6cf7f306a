// LayeredBsdf: any base under a dielectric coat, with an optional medium between, by random walks.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <optional>

#include "montelux/mc/integrate/mis.h"
#include "montelux/mc/random/philox_stream.h"
#include "montelux/mc/warp/hemisphere.h"
#include "montelux/scene/bsdf/dielectric.h"
#include "montelux/scene/bsdf/henyey_greenstein.h"

namespace montelux {

// Guo, Hasan, Zhao 2018, "Position-Free Monte Carlo Simulation for Arbitrary Layered BSDFs": the layers are
// flat and infinite, so the state of a walk is its depth z (base at 0, coat at `thickness`) and its
// direction. `evaluate` is an unbiased estimate, not the value. Its density is not known in closed form.
// evaluate and sample report as pdf a fixed positive function of the two directions; MIS weights may use it
// (they sum to 1 for any). The weight of sample is f |cos| over the true density. A coat may be stochastic itself.
template <typename Base, typename Coat>
struct LayeredBsdf {
    Coat coat;
    Base base;
    Ggx proxy;                     // roughness of light reflected by the base, for the reported pdf
    SampledSpectrum medium_albedo; // single-scattering albedo between the layers; its extinction is 1 per
                                   // unit of thickness
    float g = 0;
    float thickness = 0.01f;
    int max_depth = 10;
    int sample_count = 1;

    static constexpr const char* name = "coated by random walks";
    static constexpr BsdfTraits traits{.uses_tangents = true, .stochastic = true};
    template <typename Visit>
    void visit_fields(Visit&& visit) const {
        visit("eta", facets_of_coat().eta);
        visit("thickness", thickness);
        visit("coat", facets_of_coat().normals);
        if (!is_black(medium_albedo)) visit("medium albedo", medium_albedo);
        visit("base", base);
    }

    bool is_specular() const { return coat.is_specular() && base.is_specular() && is_black(medium_albedo); }
    bool has_specular() const { return coat.is_specular(); }
    // The base, and light that the medium scatters.
    bool has_diffuse() const { return base.has_diffuse() || !is_black(medium_albedo); }
    // Without interreflections between the layers.
    SampledSpectrum albedo(Vec3f wo) const {
        float r = fresnel_dielectric(abs_cos_theta(wo), facets_of_coat().eta);
        return r + (1 - r) * base.albedo(wo);
    }

    template <typename Stream>
    BsdfEvaluation evaluate(Vec3f wo, Vec3f wi, TransportMode mode, Stream& stream) const {
        if (!same_hemisphere(wo, wi) || is_specular()) return {};
        // Both sides are coated.
        if (wo.z < 0) {
            wo = -wo;
            wi = -wi;
        }
        SampledSpectrum walks;
        PhiloxStream rng = PhiloxStream::split(stream);
        for (int i = 0; i < sample_count; ++i) walks += walk(wo, wi, mode, rng);
        BsdfEvaluation result = coat_value(wo, wi, mode, Lobes::reflection, rng);
        result.f += walks / static_cast<float>(sample_count);
        result.pdf = proxy_pdf(wo, wi);
        return result;
    }

    template <typename Stream>
    std::optional<BsdfSample> sample(Vec3f wo, TransportMode mode, Stream& stream) const {
        bool below = wo.z < 0;
        if (below) wo = -wo;
        PhiloxStream rng = PhiloxStream::split(stream);
        float uc = rng.next_1d();
        Vec2f u = rng.next_2d();
        auto s = coat.sample_lobes(wo, uc, u, mode, Lobes::both);
        if (!s) return std::nullopt;
        if (s->transmission && !leave(*s, mode, rng)) return std::nullopt;
        if (!s->specular) s->pdf = proxy_pdf(wo, s->wi);
        if (!(s->pdf > 0)) return std::nullopt;
        s->transmission = false;
        s->eta = 1;
        if (below) s->wi = -s->wi;
        return s;
    }

  private:
    const DielectricBsdf& facets_of_coat() const {
        if constexpr (std::same_as<Coat, DielectricBsdf>)
            return coat;
        else
            return coat.facets;
    }
    BsdfEvaluation coat_value(Vec3f wo, Vec3f wi, TransportMode mode, Lobes lobes, PhiloxStream& rng) const {
        if constexpr (Coat::traits.stochastic)
            return coat.evaluate_lobes(wo, wi, mode, lobes, rng);
        else
            return coat.evaluate_lobes(wo, wi, mode, lobes);
    }
    float coat_pdf(Vec3f wo, Vec3f wi, TransportMode mode, Lobes lobes) const {
        if constexpr (Coat::traits.stochastic)
            return coat.pdf_lobes(wo, wi, mode, lobes);
        else
            return coat.evaluate_lobes(wo, wi, mode, lobes).pdf;
    }

    float absorption(float dz, Vec3f w) const { return std::exp(-std::abs(dz / w.z)); }

    float proxy_pdf(Vec3f wo, Vec3f wi) const {
        float r = std::clamp(fresnel_dielectric(wo.z, facets_of_coat().eta), 0.1f, 0.9f);
        float cosine = inv_pi_f * wi.z;
        Vec3f m = normalize(wo + wi);
        float lobe = proxy.visible_pdf(wo, m) / (4 * std::max(dot(wo, m), 1e-6f));
        float top = coat.is_specular() ? lobe : coat_pdf(wo, wi, TransportMode::radiance, Lobes::reflection);
        return r * top + (1 - r) * (0.8f * lobe + 0.2f * cosine);
    }

    // One step of a walk at depth z along w: to the other interface, or to a scattering event between.
    // Returns false for the latter; z is the new depth.
    bool reaches_interface(float& z, Vec3f w, SampledSpectrum& beta, PhiloxStream& rng) const {
        if (is_black(medium_albedo)) {
            z = z == 0 ? thickness : 0;
            beta *= absorption(thickness, w);
            return true;
        }
        float u = rng.next_1d();
        float dz = -std::log1p(-u) * std::abs(w.z);
        float next = w.z > 0 ? z + dz : z - dz;
        if (next > 0 && next < thickness) {
            z = next;
            return false;
        }
        z = w.z > 0 ? thickness : 0;
        return true;
    }

    // Follows a walk that has entered through the coat until it leaves; s becomes the whole event. After
    // max_depth events it may still leave, as in `walk`.
    bool leave(BsdfSample& s, TransportMode mode, PhiloxStream& rng) const {
        SampledSpectrum beta = s.weight;
        Vec3f w = s.wi;
        float z = thickness;
        for (int depth = 0; depth <= max_depth; ++depth) {
            const bool may_scatter = depth < max_depth;
            if (!survives(depth, beta, rng) || w.z == 0) return false;
            if (!reaches_interface(z, w, beta, rng)) {
                if (!may_scatter) return false;
                Vec2f u = rng.next_2d();
                w = HenyeyGreenstein{g}.sample(-w, u).wi;
                beta *= medium_albedo;
                s.specular = false;
                continue;
            }
            std::optional<BsdfSample> event;
            if (z == 0) {
                if (!may_scatter) return false;
                event = base.sample(-w, mode, rng);
            } else {
                float uc = rng.next_1d();
                Vec2f u = rng.next_2d();
                event = coat.sample_lobes(-w, uc, u, mode, Lobes::both);
            }
            if (!event) return false;
            beta *= event->weight;
            s.specular = s.specular && event->specular;
            w = event->wi;
            if (event->transmission) {
                s.weight = beta;
                s.wi = w;
                return true;
            }
        }
        return false;
    }

    // Light with at least one visit to the base or the medium, times |cos theta_i|.
    SampledSpectrum walk(Vec3f wo, Vec3f wi, TransportMode mode, PhiloxStream& rng) const {
        float uc_o = rng.next_1d(), uc_i = rng.next_1d();
        Vec2f u_o = rng.next_2d();
        Vec2f u_i = rng.next_2d();
        auto in = coat.sample_lobes(wo, uc_o, u_o, mode, Lobes::transmission);
        // The exit path that ends in wi, traced backwards.
        auto out = coat.sample_lobes(wi, uc_i, u_i, adjoint(mode), Lobes::transmission);
        if (!in || in->wi.z == 0) return {};
        // A stochastic coat may reflect the path from wi: its weight is 0 then, and exits are found by chance alone.
        const bool has_out = out && out->wi.z != 0;
        if (!has_out && !Coat::traits.stochastic) return {};
        bool rough = !coat.is_specular();
        Vec3f to_exit{0, 0, 1};
        SampledSpectrum exit_weight;
        if (has_out) {
            to_exit = -out->wi;
            exit_weight = out->weight * (abs_cos_theta(wi) / abs_cos_theta(out->wi));
        }
        auto out_weight = [&](float other_pdf) {
            return rough ? power_heuristic(1, out->pdf, 1, other_pdf) : 1.0f;
        };
        auto exit_by_chance = [&](Vec3f w, float pdf, float dz, bool delta) {
            BsdfEvaluation exit = coat_value(-w, wi, mode, Lobes::transmission, rng);
            // The competing strategy starts from wi: its density is that of sampling -w there.
            float out_pdf = coat_pdf(wi, -w, adjoint(mode), Lobes::transmission);
            float weight = delta ? 1 : power_heuristic(1, pdf, 1, out_pdf);
            return exit.f * (absorption(dz, w) * weight);
        };

        // Between two mirrors light that scattered upwards (with density p_up of to_exit) or downwards may go
        // up and down before it leaves; only the scattering decides the direction.
        const bool mirrors = !rough && base.is_specular();
        SampledSpectrum base_mirrors, round_trip;
        if (mirrors) {
            const float once = absorption(thickness, to_exit);
            if (auto up = base.sample({-to_exit.x, -to_exit.y, to_exit.z}, mode, rng))
                base_mirrors = up->weight * once;
            if (auto down = coat.sample_lobes(out->wi, 0, {}, mode, Lobes::reflection))
                round_trip = base_mirrors * down->weight * once;
        }
        auto ways_out = [&](float p_up, float p_down, float z, int depth) {
            SampledSpectrum ways, up{p_up * absorption(z - thickness, to_exit)};
            SampledSpectrum down = base_mirrors * (p_down * absorption(z, to_exit));
            for (; depth < max_depth; depth += 2) {
                ways += up;
                if (depth + 1 < max_depth) ways += down;
                up *= round_trip;
                down *= round_trip;
            }
            return ways;
        };

        SampledSpectrum sum, beta = in->weight;
        Vec3f w = in->wi;
        float z = thickness;
        for (int depth = 0; depth < max_depth; ++depth) {
            if (!survives(depth, beta, rng) || w.z == 0) break;
            if (!reaches_interface(z, w, beta, rng)) {
                HenyeyGreenstein phase{g};
                float p = phase.pdf(-w, to_exit);
                if (mirrors)
                    sum += beta * medium_albedo * exit_weight *
                           ways_out(p, phase.pdf(-w, {to_exit.x, to_exit.y, -to_exit.z}), z, depth);
                else if (has_out)
                    sum += beta * medium_albedo * exit_weight *
                           (p * out_weight(p) * absorption(z - thickness, to_exit));
                Vec2f u = rng.next_2d();
                PhaseSample event = phase.sample(-w, u);
                beta *= medium_albedo;
                w = event.wi;
                if (w.z > 0 && rough) sum += beta * exit_by_chance(w, event.pdf, z - thickness, false);
            } else if (z == thickness) {
                float uc = rng.next_1d();
                Vec2f u = rng.next_2d();
                auto event = coat.sample_lobes(-w, uc, u, mode, Lobes::reflection);
                if (!event) break;
                beta *= event->weight;
                w = event->wi;
            } else {
                if (has_out && !base.is_specular()) {
                    BsdfEvaluation e = base.evaluate(-w, to_exit, mode, rng);
                    sum += beta * e.f * exit_weight * (out_weight(e.pdf) * absorption(thickness, to_exit));
                }
                auto event = base.sample(-w, mode, rng);
                if (!event || event->wi.z <= 0) break;
                beta *= event->weight;
                w = event->wi;
                if (rough) sum += beta * exit_by_chance(w, event->pdf, thickness, event->specular);
            }
        }
        return sum;
    }

    // Russian roulette for long walks of low throughput.
    static bool survives(int depth, SampledSpectrum& beta, PhiloxStream& rng) {
        float strength = max_value(beta);
        if (depth <= 3 || strength >= 0.25f) return true;
        float u = rng.next_1d();
        if (!(u < strength)) return false;
        beta /= strength;
        return true;
    }
};

} // namespace montelux
