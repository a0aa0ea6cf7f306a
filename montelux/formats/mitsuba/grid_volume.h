// GridVolume: the samples of a Mitsuba volume file (.vol).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "montelux/mc/math/vec.h"

namespace montelux::mitsuba {

struct GridVolume {
    std::array<int, 3> size{}; // samples along x, y and z
    int channels = 1;          // 1, 3 (linear sRGB) or 6
    Point3f lower, upper;      // the box that the file names
    // values[((z ny + y) nx + x) channels + channel]; finite
    std::vector<float> values;
};

// Version 3 with samples of 32-bit floats. Files are not trusted: all sizes are checked. `name` is that of the file, for
// messages. Throws Error.
GridVolume read_grid_volume(std::span<const std::uint8_t> bytes, const std::string& name);

} // namespace montelux::mitsuba
