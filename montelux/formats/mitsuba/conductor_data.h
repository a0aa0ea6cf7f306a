// ConductorData: measured optical constants by the names of Mitsuba's materials.
#pragma once

#include <span>
#include <string_view>

namespace montelux::mitsuba {

struct ConductorData {
    std::string_view name;
    // Triples: wavelength (nm), index of refraction, coefficient of absorption.
    std::span<const float> samples;
};

// In alphabetical order, without those that are named spectra (spectrum/named_spectra.h).
std::span<const ConductorData> conductor_data();

} // namespace montelux::mitsuba
