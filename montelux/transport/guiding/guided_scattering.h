// Directions drawn from a BSDF or a phase function and a guide together.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "montelux/mc/math/frame.h"
#include "montelux/mc/random/stream.h"
#include "montelux/scene/bsdf/bsdf.h"
#include "montelux/scene/medium/phase_function.h"
#include "montelux/transport/guiding/guiding_trace.h"
#include "montelux/transport/path_state.h"

namespace montelux {

// Of the region's share of the directions from the guide, and of the others from the BSDF. The pdf of a sample that is
// not specular is that of both together: the balance heuristic (Veach and Guibas 1995). The BSDF is not specular; wo
// is in its frame. `trace`, unless null, gets the direction.
template <BsdfModel B, RandomStream Stream>
std::optional<BsdfSample> sample_guided(const B& bsdf, const Frame& frame, Point3f p, Vec3f wo,
                                        const GuidingRegion& region, Stream& stream, GuidingTrace* trace) {
    const float u = stream.next_1d();
    if (u < region.share) {
        const GuidingRegion::Direction d = region.sample(p, stream.next_2d());
        BsdfSample s;
        s.wi = frame.to_local(d.wi);
        const BsdfEvaluation e = bsdf.evaluate(wo, s.wi, TransportMode::radiance, stream);
        s.pdf = region.mixed_pdf(d.pdf, e.pdf);
        if (trace != nullptr) trace->scatter(d.wi, s.pdf, e.pdf, d.pdf);
        if (is_black(e.f)) return std::nullopt;
        s.weight = e.f / s.pdf;
        s.transmission = !same_hemisphere(wo, s.wi);
        if constexpr (B::traits.transmits)
            if (s.transmission) s.eta = bsdf.transmitted_eta(wo);
        return s;
    }
    std::optional<BsdfSample> s = bsdf.sample(wo, TransportMode::radiance, stream);
    if (!s) return s;
    if (s->specular) {
        s->weight /= 1 - region.share;
        if (trace != nullptr) trace->scatter_in_delta_lobe(1 - region.share);
        return s;
    }
    const Vec3f wi = frame.to_world(s->wi);
    const float bsdf_pdf = s->pdf, guide_pdf = region.pdf(p, wi);
    s->pdf = region.mixed_pdf(guide_pdf, bsdf_pdf);
    s->weight *= bsdf_pdf / s->pdf;
    if (trace != nullptr) trace->scatter(wi, s->pdf, bsdf_pdf, guide_pdf);
    return s;
}

// The same of a phase function, in world space; the value of a sample is `weight` times its density.
struct GuidedDirection {
    Vec3f wi;
    float pdf = 0, weight = 1;
};
template <PhaseModel P, RandomStream Stream>
GuidedDirection sample_guided(const P& phase, Point3f p, Vec3f wo, const GuidingRegion& region,
                              Stream& stream, GuidingTrace* trace) {
    const float u = stream.next_1d();
    const Vec2f u_direction = stream.next_2d();
    const bool from_guide = u < region.share;
    const Vec3f wi =
        normalize(from_guide ? region.sample(p, u_direction).wi : phase.sample(wo, u_direction).wi);
    const float phase_pdf = phase.pdf(wo, wi), guide_pdf = region.pdf(p, wi);
    const float pdf = region.mixed_pdf(guide_pdf, phase_pdf);
    if (trace != nullptr) trace->scatter(wi, pdf, phase_pdf, guide_pdf);
    return {wi, pdf, phase_pdf / pdf};
}

// What a path of so much throughput is expected to bring, over what its pixel expects. Russian roulette below 1 and
// splitting from 2 on keep it near 1: Vorba and Krivanek 2016, "Adjoint-Driven Russian Roulette and Splitting in Light
// Transport Simulation".
inline float expected_share(const GuidingRegion& region, SampledSpectrum throughput, float expected) {
    return average(throughput) * region.radiance / expected;
}

// The probability of Russian roulette after `depth` events; `expected` of the pixel, 0: not known.
inline float guided_survival(const GuidingRegion& region, SampledSpectrum throughput, int depth,
                             float expected) {
    constexpr float least = 0.3f;
    if (depth <= 2 || !(expected > 0) || !region.knows_radiance()) return 1;
    return std::min(1.0f, std::max(expected_share(region, throughput, expected), least));
}

// The same at a glossy vertex, where the region does not know what the path can bring: what is not absorbed on average.
// The weight of a direction does not count, or roulette would end paths that reach strong light by a weak lobe.
inline float glossy_survival(const Bsdf& bsdf, Vec3f wo, int depth) {
    constexpr float least = 0.3f;
    return depth <= 2 ? 1 : std::clamp(max_value(albedo(bsdf, wo)), least, 1.0f);
}

// The probability that Russian roulette lets a light sample live which brings `contribution` unless something occludes
// it. Weak ones, and those in regions whose light samples are mostly occluded, are rarely traced. The variance that this
// adds and the time that it saves balance where the probability is in proportion to the root of the second moment,
// contribution times sqrt(visible) (Bolin and Meyer 1997, "An Error Metric for Monte Carlo Ray Tracing").
inline float guided_light_survival(const GuidingRegion& region, SampledSpectrum contribution,
                                   float expected) {
    constexpr float scale = 2, least = 0.05f;
    if (!(expected > 0)) return 1;
    const float wanted = scale * std::sqrt(region.visible) * average(contribution) / expected;
    return wanted >= 0 && wanted < 1 ? std::max(wanted, least) : 1; // 1 for values that are reported as bad
}

// Branches that a path continues with from a vertex where it has survived, by the same: as many as bring what the pixel
// expects, each with its part of the throughput. Branches share `most`, so that a sample never has more.
inline int guided_branches(const GuidingRegion& region, SampledSpectrum throughput, int most,
                           float expected) {
    if (!(expected > 0) || !region.knows_radiance()) return 1;
    const float wanted =
        std::min(expected_share(region, throughput, expected), float(most_branches_at_vertex));
    return wanted >= 2 ? std::min(static_cast<int>(wanted), std::max(most, 1)) : 1; // 1 for NaN
}

} // namespace montelux
