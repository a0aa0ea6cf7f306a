// Fresnel reflectance of dielectrics and conductors, unpolarised light.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "montelux/mc/math/vec.h"
#include "montelux/spectrum/sampled_spectrum.h"

namespace montelux {

// eta: index of the side that the normal does not point to over that of the side it does.
// A negative cosine means that light arrives from below. Total internal reflection gives 1.
inline float fresnel_dielectric(float cos_theta_i, float eta) {
    cos_theta_i = std::clamp(cos_theta_i, -1.0f, 1.0f);
    if (cos_theta_i < 0) {
        eta = 1 / eta;
        cos_theta_i = -cos_theta_i;
    }
    float sin2_t = (1 - cos_theta_i * cos_theta_i) / (eta * eta);
    if (sin2_t >= 1) return 1;
    float cos_theta_t = std::sqrt(1 - sin2_t);
    float parallel = (eta * cos_theta_i - cos_theta_t) / (eta * cos_theta_i + cos_theta_t);
    float perpendicular = (cos_theta_i - eta * cos_theta_t) / (cos_theta_i + eta * cos_theta_t);
    return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

// Complex index eta + ik relative to the outside; cos_theta_i in [0, 1].
// Born and Wolf, Principles of Optics, section 14.2, in the real-valued form.
inline SampledSpectrum fresnel_conductor(float cos_theta_i, SampledSpectrum eta, SampledSpectrum k) {
    float c = std::clamp(cos_theta_i, 0.0f, 1.0f);
    float c2 = c * c, s2 = 1 - c2;
    SampledSpectrum eta2 = eta * eta, k2 = k * k;
    SampledSpectrum t0 = eta2 - k2 - s2;
    SampledSpectrum a2_plus_b2 = sqrt(t0 * t0 + 4.0f * eta2 * k2);
    SampledSpectrum t1 = a2_plus_b2 + c2;
    SampledSpectrum a = sqrt(clamp_zero(0.5f * (a2_plus_b2 + t0)));
    SampledSpectrum t2 = 2.0f * c * a;
    SampledSpectrum perpendicular = (t1 - t2) / (t1 + t2);
    SampledSpectrum t3 = c2 * a2_plus_b2 + s2 * s2;
    SampledSpectrum t4 = t2 * s2;
    SampledSpectrum parallel = perpendicular * (t3 - t4) / (t3 + t4);
    return 0.5f * (parallel + perpendicular);
}

// Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering": f0 at normal incidence, f90 at
// grazing incidence.
inline SampledSpectrum fresnel_schlick(float cos_theta_i, SampledSpectrum f0, float f90) {
    const float d = 1 - std::clamp(cos_theta_i, 0.0f, 1.0f);
    const float d5 = (d * d) * (d * d) * d;
    return (1 - d5) * f0 + d5 * f90;
}

struct Refraction {
    Vec3f wt;
    float eta; // index on the side of wt over that on the side of wi
};

// wi refracted at a plane with normal n (on either side); eta as in fresnel_dielectric.
// Empty for total internal reflection.
inline std::optional<Refraction> refract(Vec3f wi, Vec3f n, float eta) {
    float cos_i = dot(n, wi);
    if (cos_i < 0) {
        eta = 1 / eta;
        cos_i = -cos_i;
        n = -n;
    }
    float sin2_t = std::max(0.0f, 1 - cos_i * cos_i) / (eta * eta);
    if (sin2_t >= 1) return std::nullopt;
    float cos_t = std::sqrt(1 - sin2_t);
    return Refraction{-wi / eta + (cos_i / eta - cos_t) * n, eta};
}

inline Vec3f reflect(Vec3f wo, Vec3f n) { return -wo + 2 * dot(wo, n) * n; }

} // namespace montelux
