// SpectrumOf: the spectrum whose samples are of a number type.
#pragma once

#include <concepts>

#include "montelux/mc/math/number.h"
#include "montelux/spectrum/wavelengths.h"

namespace montelux {

// The specialisation for lanes is in spectrum_lanes.h.
template <typename T>
struct SpectrumTraits;
template <std::floating_point T>
struct SpectrumTraits<T> {
    using Spectrum = SampledSpectrum;
};
template <Number T>
using SpectrumOf = typename SpectrumTraits<T>::Spectrum;

} // namespace montelux
