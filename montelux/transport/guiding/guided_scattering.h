// Directions drawn from a BSDF and a guide together.
#pragma once

#include <optional>

#include "montelux/mc/math/frame.h"
#include "montelux/mc/random/stream.h"
#include "montelux/scene/bsdf/bsdf_model.h"
#include "montelux/transport/guiding/guiding_trace.h"

namespace montelux {

// Of the region's share of the directions from the guide, and of the others from the BSDF. The pdf of a sample that is
// not specular is that of both together: the balance heuristic (Veach and Guibas 1995). The BSDF is not specular; wo
// is in its frame. `trace`, unless null, gets the direction.
template <BsdfModel B, RandomStream Stream>
std::optional<BsdfSample> sample_guided(const B& bsdf, const Frame& frame, Vec3f wo,
                                        const GuidingRegion& region, Stream& stream, GuidingTrace* trace) {
    const float u = stream.next_1d();
    if (u < region.share) {
        const GuidingRegion::Direction d = region.sample(stream.next_2d());
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
        return s;
    }
    const Vec3f wi = frame.to_world(s->wi);
    const float bsdf_pdf = s->pdf, guide_pdf = region.pdf(wi);
    s->pdf = region.mixed_pdf(guide_pdf, bsdf_pdf);
    s->weight *= bsdf_pdf / s->pdf;
    if (trace != nullptr) trace->scatter(wi, s->pdf, bsdf_pdf, guide_pdf);
    return s;
}

} // namespace montelux
