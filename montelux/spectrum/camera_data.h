// Measured figures behind the sensors of digital cameras; each table has its source where it is defined.
#pragma once

#include <array>
#include <string_view>

namespace montelux::measured {

// Relative response at 380, 390, ... 720 nm; 0 beyond.
struct CameraResponse {
    std::string_view name;
    std::array<float, 35> r, g, b;
};
extern const std::array<CameraResponse, 17> camera_responses; // in alphabetical order

// Reflectance at 380, 390, ... 730 nm.
extern const std::array<std::array<float, 36>, 24> color_checker;

} // namespace montelux::measured
