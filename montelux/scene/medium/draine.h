// The phase function of Draine 2003, which peaks forward as Henyey and Greenstein's and backward as Rayleigh's.
#pragma once

#include "montelux/scene/bsdf/henyey_greenstein.h"

namespace montelux {

// Draine 2003, "Scattering by Interstellar Dust Grains. I. Optical and Ultraviolet", ApJ 598, equation 6, with
// mu = -dot(wo, wi):
//   p = (1 - g^2) / (4 pi (1 + g^2 - 2 g mu)^(3/2)) (1 + alpha mu^2) / (1 + alpha (1 + 2 g^2) / 3).
// alpha = 0 is Henyey and Greenstein's; alpha = 1 and g = 0 is Rayleigh's. Jendersie and d'Eon 2023, "An
// Approximate Mie Scattering Function for Fog and Cloud Rendering", blend both for droplets of water.
struct Draine {
    static constexpr const char* name = "Draine";

    float g = 0;     // in (-1, 1)
    float alpha = 0; // at least 0

    float pdf(Vec3f wo, Vec3f wi) const {
        const float mu = -dot(wo, wi);
        return HenyeyGreenstein{g}.pdf(wo, wi) * (1 + alpha * mu * mu) / (1 + alpha * (1 + 2 * g * g) / 3);
    }
    // By inversion of the distribution of mu.
    PhaseSample sample(Vec3f wo, Vec2f u) const;
    // Draine 2003, equation 7.
    float mean_cosine() const {
        return g * (1 + alpha * (3 + 2 * g * g) / 5) / (1 + alpha * (1 + 2 * g * g) / 3);
    }
};

} // namespace montelux
