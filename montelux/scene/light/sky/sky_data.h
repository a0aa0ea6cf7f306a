// Measured data of the sky: sunlight outside the atmosphere, and absorption by ozone.
#pragma once

#include <array>

#include "montelux/spectrum/wavelengths.h"

namespace montelux {

// Spectral irradiance of the sun at its mean distance on a plane facing it, W/(m^2 nm), at 360, 361, ...
// 830 nm. ASTM G173-03, extraterrestrial column (after Gueymard 2004); below 400 nm, where that has steps of
// half a nanometre, means over one.
extern const std::array<float, visible_samples> solar_irradiance;

// Absorption of one ozone molecule at 233 K, 1e-24 m^2, at 360, 370, ... 830 nm, each the mean over the 20
// nm around it. Serdyuchenko et al. 2014, "High spectral resolution ozone absorption cross-sections - Part
// 2", by the means over 10 nm in Bruneton 2017, "Precomputed Atmospheric Scattering: a New Implementation".
extern const std::array<float, 48> ozone_cross_section;

} // namespace montelux
