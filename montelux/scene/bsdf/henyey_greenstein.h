// The phase function of Henyey and Greenstein 1941.
#pragma once

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/frame.h"

namespace montelux {

struct PhaseSample {
    Vec3f wi;
    float pdf; // per solid angle; equals the phase function's value
};

// g in (-1, 1) is the mean cosine. wo and wi point away from the scattering event: g > 0 scatters forward,
// that is towards wi = -wo.
struct HenyeyGreenstein {
    static constexpr const char* name = "Henyey-Greenstein";

    float g = 0;

    float mean_cosine() const { return g; }

    float pdf(Vec3f wo, Vec3f wi) const {
        float denominator = std::max(1 + g * g + 2 * g * dot(wo, wi), 1e-9f);
        return inv_four_pi_f * (1 - g * g) / (denominator * std::sqrt(denominator));
    }
    PhaseSample sample(Vec3f wo, Vec2f u) const {
        float cos_theta;
        if (std::abs(g) < 1e-3f) {
            cos_theta = 1 - 2 * u.x;
        } else {
            float s = (1 - g * g) / (1 + g - 2 * g * u.x);
            cos_theta = -(1 + g * g - s * s) / (2 * g);
        }
        float sin_theta = std::sqrt(std::max(0.0f, 1 - cos_theta * cos_theta));
        float phi = two_pi_f * u.y;
        Vec3f wi = Frame::from_normal(wo).to_world(
            {sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta});
        return {wi, pdf(wo, wi)};
    }
};

} // namespace montelux
