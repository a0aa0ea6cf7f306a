// The wavelengths of a path: hero wavelength sampling with densities that follow the eye.
#pragma once

#include "montelux/spectrum/sampled_spectrum.h"

namespace montelux {

// Range of visible wavelengths in nanometres: light outside it is not simulated.
inline constexpr float lambda_min = 360.0f;
inline constexpr float lambda_max = 830.0f;
// Number of 1 nm samples in that range, both ends included.
inline constexpr int visible_samples = 471;

// Four stratified wavelengths drawn from one uniform variable. Wilkie et al. 2014, "Hero Wavelength Spectral
// Sampling", Computer Graphics Forum 33(4): the path is sampled at the first wavelength (the hero); the other
// three share it.
struct SampledWavelengths {
    Float4 lambda{};     // nm, in [lambda_min, lambda_max]
    SampledSpectrum pdf; // 1/nm; 0 for a terminated wavelength

    bool operator==(const SampledWavelengths& b) const { return !any(lambda != b.lambda) && pdf == b.pdf; }

    // Importance samples the sum of the CIE matching functions by the density
    // p(lambda) = 0.0039398042 / cosh^2(0.0072 (lambda - 538)). Radziszewski, Boryczko, Alda 2009, "An
    // Improved Technique for Full Spectral Rendering", Journal of WSCG 17. u in [0, 1).
    static SampledWavelengths sample_visible(float u) {
        // lambda = 538 - artanh(x) / 0.0072, so that cosh^-2(0.0072 (lambda - 538)) = 1 - x^2.
        Float4 x = 0.85691062f - 1.82750197f * stratified(u);
        SampledWavelengths w;
        w.lambda = min(max(538.0f - 138.888889f * artanh(x), broadcast(lambda_min)), broadcast(lambda_max));
        w.pdf = SampledSpectrum(0.0039398042f * (1.0f - x * x));
        return w;
    }

    // Uniform over [low, high], which must lie within the visible range with low < high.
    static SampledWavelengths sample_uniform(float u, float low = lambda_min, float high = lambda_max) {
        SampledWavelengths w;
        w.lambda = min(low + (high - low) * stratified(u), broadcast(high));
        w.pdf = SampledSpectrum(1.0f / (high - low));
        return w;
    }

    // Density of sample_visible at one wavelength in nm (1/nm); 0 outside the visible range.
    static float visible_pdf(float wavelength) {
        if (!(wavelength >= lambda_min && wavelength <= lambda_max)) return 0;
        float c = std::cosh(0.0072f * (wavelength - 538.0f));
        return 0.0039398042f / (c * c);
    }

    // Keeps only the hero, because the path's direction depends on the wavelength. The hero was drawn as one
    // of four equally likely ones, so its density is divided by four. Calling it again changes nothing.
    void terminate_secondary() {
        if (secondary_terminated()) return;
        pdf = SampledSpectrum(0.25f * pdf[0], 0, 0, 0);
    }
    bool secondary_terminated() const { return pdf[1] == 0 && pdf[2] == 0 && pdf[3] == 0; }

  private:
    // frac(u + i/4)
    static Float4 stratified(float u) {
        Float4 v = u + Float4{0.0f, 0.25f, 0.5f, 0.75f};
        return v - select(v >= broadcast(1.0f), broadcast(1.0f), Float4{});
    }
};

} // namespace montelux
