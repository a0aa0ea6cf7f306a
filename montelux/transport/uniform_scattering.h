// Scattering into uniform directions, whatever the BSDF.
#pragma once

#include <optional>

#include "montelux/mc/random/stream.h"
#include "montelux/mc/warp/hemisphere.h"
#include "montelux/mc/warp/sphere.h"
#include "montelux/scene/bsdf/bsdf_model.h"

namespace montelux {

// Directions independent of the BSDF: uniform over the hemisphere of wo, or over the sphere if it transmits.
// A BSDF with delta and other lobes gives half of the samples to the delta lobe, which no such direction can
// find.
template <BsdfModel B, RandomStream Stream>
std::optional<BsdfSample> sample_uniform(const B& bsdf, Vec3f wo, Stream& stream) {
    float share = 1;
    if (bsdf.has_specular()) {
        share = 0.5f;
        float u_choice = stream.next_1d();
        if (u_choice < share) {
            auto s = bsdf.sample(wo, TransportMode::radiance, stream);
            if (!s || !s->specular) return std::nullopt;
            s->weight /= share;
            return s;
        }
    }
    Vec2f u = stream.next_2d();
    BsdfSample s;
    if constexpr (B::traits.transmits) {
        s.wi = sample_uniform_sphere(u);
        s.pdf = share * inv_four_pi_f;
        s.transmission = !same_hemisphere(wo, s.wi);
        if (s.transmission) s.eta = bsdf.transmitted_eta(wo);
    } else {
        s.wi = sample_uniform_hemisphere(u);
        if (wo.z < 0) s.wi.z = -s.wi.z;
        s.pdf = share * inv_two_pi_f;
    }
    BsdfEvaluation e = bsdf.evaluate(wo, s.wi, TransportMode::radiance, stream);
    s.weight = e.f / s.pdf;
    if (is_black(s.weight)) return std::nullopt;
    return s;
}

} // namespace montelux
