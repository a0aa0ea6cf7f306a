// Spectra of standard light: daylight of any colour temperature and CIE illuminant A.
#pragma once

#include "montelux/spectrum/spectrum_table.h"

namespace montelux {

// Daylight of a colour temperature in K by the CIE's D-series formulas (CIE 015:2018, section 4.1.2),
// relative to 1 at 560 nm. The nominal temperature refers to the older radiation constant c2 = 0.014380 m K,
// so that 6500 gives D65. The formulas hold from 4000 K to 25000 K: below, the light is a black body's;
// above, the spectrum of 25000 K is returned. With `round_components`, M1 and M2 are rounded to three
// decimals, as the CIE's published tables were computed.
SpectrumTable daylight(float temperature, bool round_components = false);

// The same at a correlated colour temperature in the present scale.
SpectrumTable daylight_of_correlated_temperature(double temperature, bool round_components = false);

// CIE standard illuminant D65 (CIE 015:2018, table 5), joined by straight lines from its 5 nm steps.
SpectrumTable illuminant_d65();

// The white of ACES: daylight of 6000 K in the present scale (Academy TB-2018-001).
SpectrumTable illuminant_aces_d60();

// Relative power of CIE illuminant A, 100 at 560 nm (CIE 015:2018, equation 4.1).
double illuminant_a(double lambda);

} // namespace montelux
