// Smooth reflectance spectra: a sigmoid of a quadratic polynomial in the wavelength.
#pragma once

#include "montelux/spectrum/wavelengths.h"

namespace montelux {

// S((a t + b) t + c) with t = (lambda - 360 nm) / 470 nm and S(x) = 1/2 + x / (2 sqrt(1 + x^2)); values lie
// in [0, 1]. Jakob and Hanika 2019, "A Low-Dimensional Function Space for Efficient Spectral Upsampling",
// Computer Graphics Forum 38(2), equations 3 and 4.
struct SigmoidPolynomial {
    float a = 0, b = 0, c = 0;

    // The constant spectrum `value`; exact at 0 and 1. Values outside [0, 1] are clamped.
    static SigmoidPolynomial constant(float value) {
        // The square of the limit is finite and its root exact, so that S is exactly 0 or 1 there.
        constexpr float limit = 0x1p60f;
        if (!(value > 0)) return {0, 0, -limit};
        if (value >= 1) return {0, 0, limit};
        return {0, 0, (value - 0.5f) / std::sqrt(value * (1 - value))};
    }

    SampledSpectrum sample(const SampledWavelengths& w) const {
        Float4 t = (w.lambda - lambda_min) * (1 / (lambda_max - lambda_min));
        Float4 x = (a * t + b) * t + c;
        return SampledSpectrum(0.5f + 0.5f * x / sqrt(1.0f + x * x));
    }
    float operator()(float lambda) const {
        float t = (lambda - lambda_min) * (1 / (lambda_max - lambda_min));
        float x = (a * t + b) * t + c;
        return 0.5f + 0.5f * x / std::sqrt(1 + x * x);
    }
    // Largest value within the visible range.
    float max_value() const {
        float ends = std::max((*this)(lambda_min), (*this)(lambda_max));
        float t = a < 0 ? -b / (2 * a) : -1.0f;
        if (!(t > 0 && t < 1)) return ends;
        return std::max(ends, (*this)(lambda_min + t * (lambda_max - lambda_min)));
    }
};

} // namespace montelux
