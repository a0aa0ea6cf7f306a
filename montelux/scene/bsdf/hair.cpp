#include "montelux/scene/bsdf/hair.h"

namespace montelux {

namespace {

float safe_sqrt(float x) { return std::sqrt(std::max(x, 0.0f)); }
float squared(float x) { return x * x; }
float whole_power(float x, int n) {
    float result = 1;
    for (; n > 0; n >>= 1, x *= x)
        if (n & 1) result *= x;
    return result;
}

// exp(-x) I0(x) for x >= 0: Abramowitz and Stegun 9.8.1 and 9.8.2, relative error below 1e-6.
float scaled_bessel_i0(float x) {
    if (x < 3.75f) {
        const float t = squared(x / 3.75f);
        return std::exp(-x) *
               (1 + t * (3.5156229f +
                         t * (3.0899424f +
                              t * (1.2067492f + t * (0.2659732f + t * (0.0360768f + t * 0.0045813f))))));
    }
    const float t = 3.75f / x;
    return (0.39894228f +
            t * (0.01328592f +
                 t * (0.00225319f +
                      t * (-0.00157565f +
                           t * (0.00916281f +
                                t * (-0.02057706f +
                                     t * (0.02635537f + t * (-0.01647633f + t * 0.00392377f)))))))) /
           std::sqrt(x);
}

float logistic_cdf(float x, float s) { return 1 / (1 + std::exp(-x / s)); }

float sample_logistic(float u, float s) {
    const float low = logistic_cdf(-pi_f, s);
    const float x = -s * std::log(1 / (low + u * (logistic_cdf(pi_f, s) - low)) - 1);
    return std::clamp(x, -pi_f, pi_f);
}

} // namespace

// Computed once for wo.
struct HairBsdf::Outgoing {
    float sin, cos, phi;
    float gamma_o, gamma_t; // of the offset, and refracted
    std::array<SampledSpectrum, lobes> a;
    std::array<float, lobes> probability;
    std::array<float, lobes> sin_p, cos_p, v; // theta_o turned by the scales

    Outgoing(const HairBsdf& b, Vec3f wo)
        : sin(std::clamp(wo.x, -1.0f, 1.0f)), cos(std::sqrt(wo.y * wo.y + wo.z * wo.z)),
          phi(std::atan2(wo.z, wo.y)), gamma_o(std::asin(b.h)), a(b.attenuation(sin, cos)) {
        // The modified index for the plane across the hair (Marschner et al. 2003, section 3.3).
        const float modified = safe_sqrt(b.eta * b.eta - sin * sin) / std::max(cos, 1e-6f);
        gamma_t = std::asin(std::clamp(b.h / modified, -1.0f, 1.0f));
        float sum = 0;
        for (std::size_t p = 0; p < lobes; ++p) sum += probability[p] = average(a[p]);
        for (float& q : probability) q /= sum;
        // Section 4.1: -2, 1 and 4 times the tilt.
        const float s1 = b.sin_tilt, c1 = b.cos_tilt;
        const float s2 = 2 * s1 * c1, c2 = c1 * c1 - s1 * s1;
        const float s4 = 2 * s2 * c2, c4 = c2 * c2 - s2 * s2;
        const std::array<float, lobes> sines{-s2, s1, s4, 0}, cosines{c2, c1, c4, 1};
        for (std::size_t p = 0; p < lobes; ++p) {
            sin_p[p] = sin * cosines[p] + cos * sines[p];
            cos_p[p] = std::abs(cos * cosines[p] - sin * sines[p]);
        }
        v = {b.variance, 0.25f * b.variance, 4 * b.variance, 4 * b.variance};
    }

    // phi_i - phi_o of lobe p without roughness.
    float turn(std::size_t p) const {
        const auto k = static_cast<float>(p);
        return 2 * k * gamma_t - 2 * gamma_o + k * pi_f;
    }
};

HairBsdf HairBsdf::make(float h, float eta, SampledSpectrum sigma_a, float beta_m, float beta_n, float tilt) {
    HairBsdf b;
    b.h = std::clamp(h, -1.0f, 1.0f);
    b.eta = std::max(eta, 1.0f);
    b.sigma_a = sigma_a;
    const float m = std::clamp(beta_m, 0.01f, 1.0f), n = std::clamp(beta_n, 0.01f, 1.0f);
    // Equations 7 and 8.
    b.variance = squared(0.726f * m + 0.812f * m * m + 3.7f * whole_power(m, 20));
    b.scale = 0.626657069f * (0.265f * n + 1.194f * n * n + 5.372f * whole_power(n, 22)); // sqrt(pi / 8)
    b.sin_tilt = std::sin(tilt * pi_f / 180);
    b.cos_tilt = safe_sqrt(1 - squared(b.sin_tilt));
    return b;
}

SampledSpectrum HairBsdf::sigma_a_of_reflectance(SampledSpectrum reflectance, float beta_n) {
    const float n = beta_n;
    const float d = 5.969f - 0.215f * n + 2.532f * n * n - 10.73f * whole_power(n, 3) +
                    5.574f * whole_power(n, 4) + 0.245f * whole_power(n, 5);
    SampledSpectrum result;
    for (int k = 0; k < spectrum_samples; ++k)
        result.set(k, squared(std::log(std::clamp(reflectance[k], 1e-6f, 1.0f)) / d));
    return result;
}

float HairBsdf::longitudinal(float sin_i, float cos_i, float sin_o, float cos_o, float v) {
    // cos(theta_i + theta_o) - 1, without cancellation.
    const float exponent = -0.5f * (squared(cos_i - cos_o) + squared(sin_i + sin_o));
    return scaled_bessel_i0(cos_i * cos_o / v) * std::exp(exponent / v) / (v * -std::expm1(-2 / v));
}

float HairBsdf::azimuthal(float dphi, float s) {
    const float x = std::remainder(dphi, 2 * pi_f);
    const float e = std::exp(-std::abs(x) / s);
    return e / (s * squared(1 + e)) / (logistic_cdf(pi_f, s) - logistic_cdf(-pi_f, s));
}

std::array<SampledSpectrum, HairBsdf::lobes> HairBsdf::attenuation(float sin_o, float cos_o) const {
    const float cos_t = safe_sqrt(1 - squared(sin_o / eta));
    const float modified = safe_sqrt(eta * eta - sin_o * sin_o) / std::max(cos_o, 1e-6f);
    const float cos_gamma_t = safe_sqrt(1 - squared(h / modified));
    const SampledSpectrum through =
        exp(sigma_a * (-2 * cos_gamma_t / std::max(cos_t, 1e-6f))); // one way through the hair
    const float f = fresnel_dielectric(cos_o * safe_sqrt(1 - h * h), eta);
    std::array<SampledSpectrum, lobes> a;
    a[0] = SampledSpectrum(f);
    a[1] = squared(1 - f) * through;
    a[2] = a[1] * through * f;
    // The geometric series of the rest; f is 1 only where a[1] is 0.
    a[3] = a[2] * f * through / max(1.0f - f * through, SampledSpectrum(1e-6f));
    return a;
}

SampledSpectrum HairBsdf::albedo(Vec3f wo) const {
    SampledSpectrum sum(0);
    for (const SampledSpectrum& a : attenuation(wo.x, std::sqrt(wo.y * wo.y + wo.z * wo.z))) sum += a;
    return sum;
}

BsdfEvaluation HairBsdf::evaluate(const Outgoing& o, float sin_i, float cos_i, float phi) const {
    BsdfEvaluation result{SampledSpectrum(0), 0};
    for (std::size_t p = 0; p < lobes; ++p) {
        const float about = p + 1 < lobes ? azimuthal(phi - o.turn(p), scale) : inv_two_pi_f;
        const float density = longitudinal(sin_i, cos_i, o.sin_p[p], o.cos_p[p], o.v[p]) * about;
        result.f += o.a[p] * density;
        result.pdf += o.probability[p] * density;
    }
    return result;
}

BsdfEvaluation HairBsdf::evaluate(Vec3f wo, Vec3f wi) const {
    const Outgoing o(*this, wo);
    return evaluate(o, wi.x, std::sqrt(wi.y * wi.y + wi.z * wi.z), std::atan2(wi.z, wi.y) - o.phi);
}

std::optional<BsdfSample> HairBsdf::sample(Vec3f wo, float uc, Vec2f u) const {
    const Outgoing o(*this, wo);
    std::size_t p = 0;
    while (p + 1 < lobes && uc >= o.probability[p]) uc -= o.probability[p++];
    uc = std::clamp(uc / o.probability[p], 0.0f, 1.0f);
    // d'Eon, Marschner, Hanika 2013, "Importance Sampling for Physically-Based Hair Fiber Models".
    const float v = o.v[p], least = 0x1p-25f;
    const float cosine =
        std::max(1 + v * std::log(std::max(u.x, least) + (1 - u.x) * std::exp(-2 / v)), -1.0f);
    const float sine = safe_sqrt(1 - cosine * cosine);
    const float sin_i =
        std::clamp(-cosine * o.sin_p[p] + sine * std::cos(two_pi_f * u.y) * o.cos_p[p], -1.0f, 1.0f);
    const float cos_i = safe_sqrt(1 - sin_i * sin_i);
    const float phi = p + 1 < lobes ? o.turn(p) + sample_logistic(uc, scale) : two_pi_f * uc;
    const Vec3f wi{sin_i, cos_i * std::cos(o.phi + phi), cos_i * std::sin(o.phi + phi)};
    const BsdfEvaluation e = evaluate(o, sin_i, cos_i, phi);
    if (!(e.pdf > 0) || wi.z == 0) return std::nullopt;
    return BsdfSample{
        .weight = e.f / e.pdf, .wi = wi, .pdf = e.pdf, .transmission = !same_hemisphere(wo, wi)};
}

} // namespace montelux
