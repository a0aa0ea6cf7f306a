// What every BSDF takes and returns. Directions are in the local frame: the shading normal is +z, wo and wi
// both point away from the surface.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "montelux/mc/math/vec.h"
#include "montelux/spectrum/spectrum_of.h"

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
template <Number T>
struct BsdfEvaluationOf {
    SpectrumOf<T> f; // f(wo, wi) |cos theta_i|, 1/sr times cosine
    T pdf = 0;       // of sampling wi given wo, per solid angle
};
using BsdfEvaluation = BsdfEvaluationOf<float>;

template <Number T>
struct BsdfSampleOf {
    SpectrumOf<T> weight; // f(wo, wi) |cos theta_i| / pdf; for a delta lobe its limit
    Vec3<T> wi;
    T pdf = 0;                  // per solid angle; for a delta lobe the probability of choosing it
    MaskOf<T> specular = false; // wi came from a delta lobe
    MaskOf<T> transmission = false;
    T eta = 1; // index of refraction on the side of wi over that on the side of wo
};
using BsdfSample = BsdfSampleOf<float>;

// The result of sampling a BSDF, which may find no direction.
template <Number T>
struct MaybeBsdfSample {
    BsdfSampleOf<T> sample;
    MaskOf<T> found;
};
// An optional for float.
inline std::optional<BsdfSample> sample_if(bool found, const BsdfSample& sample) {
    std::optional<BsdfSample> result;
    if (found) result = sample;
    return result;
}
template <LaneNumber T>
MaybeBsdfSample<T> sample_if(MaskOf<T> found, const BsdfSampleOf<T>& sample) {
    return {sample, found};
}

template <Number T>
T cos_theta(Vec3<T> w) {
    return w.z;
}
template <Number T>
T abs_cos_theta(Vec3<T> w) {
    using std::abs;
    return abs(w.z);
}
template <Number T>
MaskOf<T> same_hemisphere(Vec3<T> a, Vec3<T> b) {
    return a.z * b.z > 0;
}

} // namespace montelux
