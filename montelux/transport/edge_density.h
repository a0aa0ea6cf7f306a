// EdgeDensity: how media along an edge of a path change the density of finding it, at each wavelength.
#pragma once

#include <span>
#include <vector>

#include "montelux/spectrum/sampled_spectrum.h"

namespace montelux {

// Both are relative to the density by which the edge was sampled, which is that of the first wavelength. They contain
// the scattering coefficient at the end of the edge.
//
// A path contains the null collisions along its edges. Both ways to follow an edge draw tentative collisions at the
// rate of the majorant; delta tracking then lets sigma_n of it pass, ratio tracking all of it. So both densities, and
// their ratio, are known in closed form at each of the collisions, although the transmittance is not (Miller, Georgiev,
// Jarosz 2019, "A Null-Scattering Path Integral Formulation of Light Transport", section 5). In homogeneous media
// ratio tracking has no collisions: the two are sigma_s exp(-sigma_t d) and sigma_s. Neither depends on which of its
// ends the edge was sampled from.
struct EdgeDensity {
    SampledSpectrum walked{1}; // of a subpath that goes along the edge
    SampledSpectrum joined{1}; // of joining its ends

    void take(SampledSpectrum factor) {
        walked *= factor;
        joined *= factor;
    }
};

// The factors by which media change the densities of all strategies of a path of n vertices (strategy_weight.h), given
// its n - 1 edges from the light to the lens. Strategy s >= 1 joins edge s - 1 and walks all others; s = 0 walks all.
// So the transmittances of all edges but the joined one, and the coefficients of all vertices, are common to all
// strategies at one wavelength; they weight the wavelengths.
//
// Each factor is the mean over the wavelengths, one of which was the first at random: a strategy's samples have that
// density, whichever was it. The factor of the strategy that found the path divides its contribution. `first_alone`:
// where the others have been terminated. `scratch` is memory.
void media_factors(std::span<const EdgeDensity> edges, bool first_alone, std::vector<double>& factors,
                   std::vector<double>& scratch);

} // namespace montelux
