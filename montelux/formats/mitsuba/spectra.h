// Spectra of a Mitsuba scene: colours, numbers, tables and the plugins that are spectra.
#pragma once

#include "montelux/formats/mitsuba/plugin.h"
#include "montelux/spectrum/spectrum.h"

namespace montelux::mitsuba {

// What the values of a colour are.
enum class SpectrumUse : std::uint8_t {
    reflectance, // within [0, 1]
    unbounded,   // not negative
};

// Whether a plugin of the kind texture is a spectrum, the same everywhere, rather than a picture or a pattern.
bool is_spectrum(const Plugin& texture);

// Of a property of `owner` that is a colour, a number, a spectrum or an object that is_spectrum. Throws Error for others,
// and for values that are out of range: `use` holds for colours and numbers.
Spectrum spectrum_of(const Property& property, SpectrumUse use, const SceneGraph& graph);

// A radiance, intensity or irradiance: `scale` times `spectrum`, in the units of Montelux's lights. Colours and numbers
// are multiples of the white D65; what is given as a spectrum is absolute, so that the constant 1 has a luminance of 1.
struct EmittedSpectrum {
    Spectrum spectrum;
    float scale = 1;
};
EmittedSpectrum emitted_spectrum_of(const Property& property, const SceneGraph& graph);
// A multiple of the white D65: of emitters that do not say how bright they are.
EmittedSpectrum white_light(double value);

} // namespace montelux::mitsuba
