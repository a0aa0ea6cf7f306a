// Scattering along lines of sight from the ground to the top of the atmosphere.
#pragma once

#include <span>
#include <vector>

#include "montelux/scene/light/sky/scattered_light.h"

namespace montelux {

// For sunlight of irradiance 1 outside.
struct LineOfSight {
    Bands smooth;  // scattered by air, or more than once
    Bands aureole; // scattered once by aerosol, over aerosol_phase
};

// From sea level, looking with cosine mu >= 0 to the zenith, at each of the azimuths from that of the sun
// whose cosines are given.
std::vector<LineOfSight> look(const Atmosphere& atmosphere, const ScatteredLight& scattered,
                              double sun_zenith, double mu, std::span<const double> cos_azimuths);

} // namespace montelux
