// Measured spectra behind the named spectra: numbers only, each table with its source where it is defined.
#pragma once

#include <array>
#include <span>

namespace montelux::measured {

// values[i] is at first + i step (nm).
struct EvenSamples {
    float first, step;
    std::span<const float> values;
};

// values[i] is at lambda[i] (nm), ascending.
struct UnevenSamples {
    std::span<const float> lambda, values;
};

// Relative spectral power.
extern const EvenSamples illuminant_d65;
extern const std::array<EvenSamples, 12> fluorescent_lamps; // FL1 to FL12
// Components of daylight at 360, 370, ... 830 nm.
extern const std::array<float, 48> d_series_s0, d_series_s1, d_series_s2;

// Index of refraction eta and absorption k in turn: silver, aluminium, gold, copper.
extern const std::array<UnevenSamples, 8> metals_at_photon_energies;
extern const EvenSamples brass_eta, brass_k;
// Pairs of wavelength (nm) and value.
extern const std::span<const float> magnesium_oxide_eta, magnesium_oxide_k;
extern const std::span<const float> titanium_dioxide_eta, titanium_dioxide_k;

} // namespace montelux::measured
