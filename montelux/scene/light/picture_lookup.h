// PictureLookup: how lights take colours from their pictures.
#pragma once

#include <cstdint>

namespace montelux {

enum class PictureLookup : std::uint8_t {
    bilinear,  // between the centres of texels; those of the border go on to the edges
    repeating, // bilinear, with the texels of the opposite border beyond the edges
    nearest,
};

} // namespace montelux
