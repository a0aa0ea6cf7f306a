// Measured coefficients of media, by the names that pbrt-v4 scene files use.
#pragma once

#include <span>
#include <string_view>

#include "montelux/mc/math/vec.h"

namespace montelux {

// Per millimetre, for the red, green and blue of sRGB. Scattering is reduced: sigma_s (1 - g).
struct MediumPreset {
    std::string_view name;
    Vec3f sigma_s, sigma_a;
};
std::span<const MediumPreset> medium_presets();

} // namespace montelux
