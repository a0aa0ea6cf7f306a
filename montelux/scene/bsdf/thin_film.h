// ThinFilm: the reflectance of a film whose thickness is of the order of a wavelength.
#pragma once

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/constants.h"
#include "montelux/spectrum/sampled_spectrum.h"

namespace montelux {

// A clear film between air and a base with a real index of refraction, coherent light without polarisation.
// Airy's sum of all reflections inside the film, for each wavelength (Born and Wolf, Principles of Optics,
// section 7.6; Belcour and Barla 2017, "A Practical Extension to Microfacet Theory for the Modeling of Varying
// Iridescence", whose integral over the spectrum is not needed here).
struct ThinFilm {
    float ior = 1.3f;    // at least 1
    Float4 phase_rate{}; // phase 4 pi ior thickness / lambda of a round trip at normal incidence

    static ThinFilm make(float ior, float thickness_nm, Float4 lambda_nm) {
        return {ior, 4 * pi_f * ior * thickness_nm / lambda_nm};
    }

    // cos_theta: of the direction in air, in [0, 1]. base_ior: at least 1.
    SampledSpectrum reflectance(float cos_theta, SampledSpectrum base_ior) const {
        return of_amplitudes(cos_theta, base_ior, [&](float a, float b, float cos_inside, int k) {
            const float x = 2 * a * b * std::cos(phase_rate[k] * cos_inside);
            const float a2 = a * a, b2 = b * b;
            return std::clamp((a2 + b2 + x) / (1 + a2 * b2 + x), 0.0f, 1.0f);
        });
    }

    // The least upper bound of `reflectance` over all thicknesses.
    SampledSpectrum greatest_reflectance(float cos_theta, SampledSpectrum base_ior) const {
        return of_amplitudes(cos_theta, base_ior, [](float a, float b, float, int) {
            const float r = (std::abs(a) + std::abs(b)) / (1 + std::abs(a * b));
            return r * r;
        });
    }

    // A number f0 for each wavelength so that Schlick's reflectance from f0 to 1 is nowhere below
    // greatest_reflectance.
    SampledSpectrum schlick_bound(SampledSpectrum base_ior) const {
        // For what lies between the angles below.
        constexpr float margin = 0.004f;
        SampledSpectrum f0;
        for (float cos_theta : {0.001f, 0.003f, 0.01f, 0.02f, 0.05f, 0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f, 0.7f,
                                0.8f, 0.9f, 1.0f}) {
            const float d = 1 - cos_theta, d5 = (d * d) * (d * d) * d;
            f0 = max(f0, (greatest_reflectance(cos_theta, base_ior) - d5) / (1 - d5) + margin);
        }
        return clamp(f0, 0, 1);
    }

  private:
    // The mean over both polarisations of combine(r12, r23, cosine inside the film, index of wavelength).
    template <typename Combine>
    SampledSpectrum of_amplitudes(float cos_theta, SampledSpectrum base_ior, const Combine& combine) const {
        const float c1 = std::clamp(cos_theta, 0.0f, 1.0f);
        const float sin2 = 1 - c1 * c1;
        const float c2 = std::sqrt(std::max(0.0f, 1 - sin2 / (ior * ior)));
        if (c1 == 0) return SampledSpectrum(1);
        const float s12 = (c1 - ior * c2) / (c1 + ior * c2);
        const float p12 = (ior * c1 - c2) / (ior * c1 + c2);
        SampledSpectrum result;
        for (int k = 0; k < spectrum_samples; ++k) {
            const float n = base_ior[k];
            const float c3 = std::sqrt(std::max(0.0f, 1 - sin2 / (n * n)));
            const float s23 = (ior * c2 - n * c3) / (ior * c2 + n * c3);
            const float p23 = (n * c2 - ior * c3) / (n * c2 + ior * c3);
            result.set(k, 0.5f * (combine(s12, s23, c2, k) + combine(p12, p23, c2, k)));
        }
        return result;
    }
};

// The real index of refraction that reflects f0 at normal incidence from air.
inline SampledSpectrum ior_from_reflectance(SampledSpectrum f0) {
    const SampledSpectrum s = sqrt(clamp(f0, 0, 0.9999f));
    return (1.0f + s) / (1.0f - s);
}

} // namespace montelux
