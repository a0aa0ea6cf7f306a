// MicrofacetPair: the microfacet that connects two directions, and the density of finding it.
#pragma once

#include <cmath>
#include <optional>

#include "montelux/mc/math/vec.h"
#include "montelux/scene/bsdf/ggx.h"

namespace montelux {

// Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces".
struct MicrofacetPair {
    Vec3f m;         // on the upper hemisphere
    float o_m, i_m;  // cosines of wo and wi to m, with the signs of their sides
    float density;   // of wi by visible microfacets, if all reflect or all refract; per solid angle
    float shadowing; // G2 / G1(wo): value / density for a reflectance or transmittance of 1

    // eta_p: index on the side of wi over that on the side of wo; 1 for reflection. Empty if no microfacet shows
    // its right side to both.
    template <typename Normals>
    static std::optional<MicrofacetPair> find(const Normals& normals, Vec3f wo, Vec3f wi, bool reflects,
                                              float eta_p) {
        MicrofacetPair p;
        p.m = wi * eta_p + wo;
        const float len2 = length_squared(p.m);
        if (!(len2 > 0)) return std::nullopt;
        p.m = p.m / std::sqrt(len2);
        if (p.m.z < 0) p.m = -p.m;
        p.o_m = dot(wo, p.m);
        p.i_m = dot(wi, p.m);
        // Microfacets seen from behind.
        if (p.i_m * wi.z < 0 || p.o_m * wo.z < 0) return std::nullopt;
        const InverseMasking masking = normals.inverse_masking(wo, wi);
        const float d = normals.d(p.m);
        p.shadowing = masking.visible / masking.both;
        const float visible = d * std::abs(p.o_m) / (masking.visible * std::abs(wo.z));
        if (reflects) {
            p.density = visible / (4 * std::abs(p.o_m));
        } else {
            const float denominator = p.i_m + p.o_m / eta_p;
            p.density = visible * std::abs(p.i_m) / (denominator * denominator);
        }
        return p;
    }
};

} // namespace montelux
