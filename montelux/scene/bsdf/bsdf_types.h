// What every BSDF takes and returns. Directions are in the local frame: the shading normal is +z, wo and wi
// both point away from the surface.
#pragma once

#include <cstdint>

#include "montelux/mc/math/vec.h"
#include "montelux/spectrum/sampled_spectrum.h"

namespace montelux {

// What flows along wo. Radiance is scaled by 1/eta^2 where it crosses an interface, importance is not
// (Veach 1997, chapter 5).
enum class TransportMode : std::uint8_t { radiance, importance };

inline constexpr TransportMode adjoint(TransportMode mode) {
    return mode == TransportMode::radiance ? TransportMode::importance : TransportMode::radiance;
}

// What all BSDFs of one type have in common.
struct BsdfTraits {
    bool transmits = false;     // light may leave on the other side of the surface
    bool uses_tangents = false; // lobes may depend on the direction of the tangents
    bool stochastic = false;    // evaluate estimates the value by random walks
};

// Value and density for a given pair of directions; lobes that are Dirac deltas count as zero in both.
struct BsdfEvaluation {
    SampledSpectrum f; // f(wo, wi) |cos theta_i|, 1/sr times cosine
    float pdf = 0;     // of sampling wi given wo, per solid angle
};

struct BsdfSample {
    SampledSpectrum weight; // f(wo, wi) |cos theta_i| / pdf; for a delta lobe its limit
    Vec3f wi;
    float pdf = 0;         // per solid angle; for a delta lobe the probability of choosing it
    bool specular = false; // wi came from a delta lobe
    bool transmission = false;
    float eta = 1; // index of refraction on the side of wi over that on the side of wo
};

inline float cos_theta(Vec3f w) { return w.z; }
inline float abs_cos_theta(Vec3f w) { return std::abs(w.z); }
inline bool same_hemisphere(Vec3f a, Vec3f b) { return a.z * b.z > 0; }

} // namespace montelux
