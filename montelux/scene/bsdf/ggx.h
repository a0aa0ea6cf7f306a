// The GGX (Trowbridge-Reitz) distribution of microfacet normals and the sampling of the visible ones.
#pragma once

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/vec.h"

namespace montelux {

// Reciprocals of Smith's functions for a pair of directions.
struct InverseMasking {
    float visible; // 1/G1(wo) in the density of visible normals
    float both;    // 1/G(wo, wi), masking and shadowing
};

// Symbols after Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", and Heitz
// 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs". Local frame, macronormal
// +z.
struct Ggx {
    float alpha_x = 0, alpha_y = 0;

    // Below this roughness a surface is treated as a perfect mirror.
    static constexpr float smooth_limit = 1e-3f;
    static float alpha_from_roughness(float roughness) { return std::sqrt(std::max(roughness, 0.0f)); }

    bool is_smooth() const { return std::max(alpha_x, alpha_y) < smooth_limit; }

    // Twice as rough, but between 0.1 and 0.3; rougher ones as they are (pbrt-v4's regularization).
    Ggx widened() const {
        const auto widen = [](float a) { return a < 0.3f ? std::clamp(2 * a, 0.1f, 0.3f) : a; };
        return {widen(alpha_x), widen(alpha_y)};
    }

    // D(m), per solid angle of m (1/sr); m on the upper hemisphere.
    // In components instead of tan(theta): exact also for narrow lobes.
    float d(Vec3f m) const {
        float x = m.x / alpha_x, y = m.y / alpha_y;
        float t = x * x + y * y + m.z * m.z;
        return inv_pi_f / (alpha_x * alpha_y * t * t);
    }

    // Smith's Lambda(w); infinite for w in the plane of the surface.
    float lambda(Vec3f w) const {
        float x = alpha_x * w.x, y = alpha_y * w.y;
        return 0.5f * (std::sqrt(1 + (x * x + y * y) / (w.z * w.z)) - 1);
    }
    float g1(Vec3f w) const { return 1 / (1 + lambda(w)); }
    // Height-correlated masking and shadowing.
    float g(Vec3f wo, Vec3f wi) const { return 1 / (1 + lambda(wo) + lambda(wi)); }

    InverseMasking inverse_masking(Vec3f wo, Vec3f wi) const {
        const float visible = 1 + lambda(wo);
        return {visible, visible + lambda(wi)};
    }

    // Density of the normals visible from w: G1(w) / |cos theta| D(m) |w.m|, per solid angle of m.
    float visible_pdf(Vec3f w, Vec3f m) const { return g1(w) / std::abs(w.z) * d(m) * std::abs(dot(w, m)); }

    // Samples the visible normals. w may lie on either side, which is then the outside; m has z >= 0.
    Vec3f sample_visible(Vec3f w, Vec2f u) const { return sample_facing(w.z < 0 ? -w : w, u); }

    // The same for a direction of microscopic light, which also comes from below (w.z < 0): the normals with z > 0
    // that face w. Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps", Computer Graphics
    // Forum 42(8).
    Vec3f sample_facing(Vec3f w, Vec2f u) const {
        Vec3f standard = normalize(Vec3f{w.x * alpha_x, w.y * alpha_y, w.z});
        float phi = two_pi_f * u.x;
        float z = (1 - u.y) * (1 + standard.z) - standard.z;
        float sin_theta = std::sqrt(std::max(0.0f, 1 - z * z));
        Vec3f h = Vec3f{sin_theta * std::cos(phi), sin_theta * std::sin(phi), z} + standard;
        // h may be rounded to just below the horizon.
        return normalize(Vec3f{h.x * alpha_x, h.y * alpha_y, std::max(1e-6f, h.z)});
    }
};

} // namespace montelux
