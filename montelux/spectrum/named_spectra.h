// Measured spectra by the names that pbrt-v4 scene files use.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "montelux/spectrum/spectrum.h"

namespace montelux {

// stdillum-A, -D50, -D65, -F1 ... -F12, illum-acesD60: relative power of illuminants, scaled so that the
//   integral against the CIE's Y is cie_y_integral.
// metal-Ag, -Al, -Au, -Cu, -CuZn, -MgO, -TiO2, each with -eta and -k: complex index of refraction.
// glass-BK7, -BAF10, -FK51A, -LASF9, -SF5, -SF10, -SF11 (the last three also -F5, -F10, -F11): index of
//   refraction.
// Beyond its first and last wavelength a spectrum keeps the value it has there. Empty for other names.
std::optional<Spectrum> find_named_spectrum(std::string_view name);

// Every name, in alphabetical order.
const std::vector<std::string_view>& named_spectrum_names();

// The known name with the fewest edits from `name`, for error sentences.
std::string_view nearest_spectrum_name(std::string_view name);

} // namespace montelux
