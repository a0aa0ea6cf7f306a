// MicrosurfaceWalk: light that travels between the microfacets of a rough surface until it leaves.
#pragma once

#include <algorithm>
#include <cmath>

#include "montelux/mc/random/philox_stream.h"
#include "montelux/scene/bsdf/ggx.h"
#include "montelux/spectrum/sampled_spectrum.h"

namespace montelux {

// Heitz, Hanika, d'Eon, Dachsbacher 2016, "Multiple-Scattering Microfacet BSDFs with the Smith Model", ACM
// Transactions on Graphics 35(4). Facets are uncorrelated: a height h matters only through C1(h), the share of the
// surface below it, and light that travels upwards from h escapes with probability C1(h)^Lambda.
// So free flights are exponential in ln C1, with rate Lambda(w) upwards and 1 + Lambda(w) downwards, and the result
// does not depend on the distribution of heights.
//
// The frame has the outside of the surface, where the light is, at +z.
struct MicrosurfaceWalk {
    Ggx ggx;
    Vec3f w;              // direction of travel
    float log_height = 0; // ln C1(h), at most 0: above all facets

    // After this number of events a walk is given up. Walks reach it at alpha above 50 only: of 4 million at alpha 1
    // the longest has 12 events, at alpha 10 it has 54.
    static constexpr int most_events = 256;

    // Flies to the next facet; false if the light leaves the surface.
    bool advance(float u) {
        const float optical_depth = -std::log1p(-u);
        const float z = std::abs(w.z), r = length_of_stretched(w);
        // Lambda = (r - z) / (2 z) without cancellation.
        if (w.z < 0) {
            log_height -= optical_depth * (2 * z) / (r + z);
            return true;
        }
        const float lambda_z = stretched_across(w) / (2 * (r + z)); // Lambda times z
        log_height += optical_depth * z / lambda_z;
        // Not a number only where Lambda is 0: there light leaves.
        return log_height < 0;
    }

    // Probability of leaving along `direction` (z > 0) from the height with this ln C1.
    float escape(Vec3f direction, float log_c) const {
        const float lambda =
            stretched_across(direction) / (2 * (length_of_stretched(direction) + direction.z) * direction.z);
        return std::exp(lambda * log_c);
    }
    float escape(Vec3f direction) const { return escape(direction, log_height); }

    // The height seen from the other side of the surface, where C1 becomes 1 - C1.
    float log_height_beyond() const {
        const float below =
            log_height > -0.7f ? std::log(-std::expm1(log_height)) : std::log1p(-std::exp(log_height));
        return std::max(below, -80.0f);
    }

    // The facet that the light hits, from the side that it comes from.
    Vec3f sample_facet(Vec2f u) const { return ggx.sample_facing(-w, u); }
    // Density of that facet's normal m, without the factor |w.m| D(m).
    float facet_density_scale() const { return 1 / projected_area(-w); }

  private:
    // Area of the facets that v sees, per area of the surface and projected along v; also for v below.
    float projected_area(Vec3f v) const {
        const float r = length_of_stretched(v);
        return v.z < 0 ? stretched_across(v) / (2 * (r - v.z)) : (r + v.z) / 2;
    }
    float stretched_across(Vec3f v) const {
        const float x = ggx.alpha_x * v.x, y = ggx.alpha_y * v.y;
        return x * x + y * y;
    }
    float length_of_stretched(Vec3f v) const { return std::sqrt(stretched_across(v) + v.z * v.z); }
};

// Russian roulette for walks of low throughput.
inline bool survives_roulette(int event, SampledSpectrum& beta, PhiloxStream& rng) {
    const float strength = max_value(beta);
    if (event < 3 || strength >= 0.25f) return true;
    const float u = rng.next_1d();
    if (!(u < strength)) return false;
    beta /= strength;
    return true;
}

// Roughly the share of the light that meets more than one facet, above 0: weight of a diffuse lobe in reported
// densities.
inline float share_of_further_events(const Ggx& ggx) {
    const float x = 1.5f * ggx.alpha_x * ggx.alpha_y;
    return 0.01f + 0.98f * x / (1 + x);
}

} // namespace montelux
