// The Beckmann distribution of microfacet normals and the sampling of the visible ones.
#pragma once

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/constants.h"
#include "montelux/scene/bsdf/ggx.h"

namespace montelux {

// A Gaussian random surface of slopes. Symbols as of Ggx.
struct Beckmann {
    float alpha_x = 0, alpha_y = 0;

    // D(m), per solid angle of m (1/sr); m on the upper hemisphere.
    float d(Vec3f m) const {
        const float x = m.x / alpha_x, y = m.y / alpha_y, z2 = m.z * m.z;
        const float slope2 = (x * x + y * y) / z2;
        if (!(slope2 < 80)) return 0; // 1/z2 overflows before exp(-slope2) vanishes
        return inv_pi_f * std::exp(-slope2) / (alpha_x * alpha_y * z2 * z2);
    }

    // Smith's Lambda(w) in the rational approximation of Walter et al. 2007, whose G1 has a relative error below
    // 0.35 %; infinite for w in the plane of the surface.
    float lambda(Vec3f w) const {
        const float a = std::sqrt(squared_cotangent(w));
        if (!(a < 1.6f)) return 0;
        return std::max(0.0f, 1 - 1.259f * a + 0.396f * a * a) / (3.535f * a + 2.181f * a * a);
    }
    // Without the approximation.
    float exact_lambda(Vec3f w) const {
        const float a2 = squared_cotangent(w), a = std::sqrt(a2);
        if (!(a < 4)) return 0;
        return std::max(0.0f, std::exp(-a2) / (2 * a * sqrt_pi) - std::erfc(a) / 2);
    }

    // Independent masking and shadowing. The density of visible normals has the exact G1.
    InverseMasking inverse_masking(Vec3f wo, Vec3f wi) const {
        return {1 + exact_lambda(wo), (1 + lambda(wo)) * (1 + lambda(wi))};
    }

    // Samples the visible normals, as Ggx::sample_visible does.
    Vec3f sample_visible(Vec3f w, Vec2f u) const;

  private:
    static constexpr float sqrt_pi = 1.7724538509f;

    // Of the angle of w to the normal of the surface stretched to alpha 1.
    float squared_cotangent(Vec3f w) const {
        const float x = alpha_x * w.x, y = alpha_y * w.y;
        return w.z * w.z / (x * x + y * y);
    }
};

} // namespace montelux
