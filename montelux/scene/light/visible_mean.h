// The mean of a spectrum over the visible wavelengths, by which powers of lights are compared.
#pragma once

#include "montelux/spectrum/spectrum.h"

namespace montelux {

// Over samples 5 nm apart.
double visible_mean(const Spectrum& s);

} // namespace montelux
