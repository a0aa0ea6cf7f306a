// Pictures as NumPy arrays and back.
#pragma once

#include "python/src/scene_slots.h"
#include <memory>
#include <nanobind/nanobind.h>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/image/image.h"
#include "montelux/scene/light/environment/environment_grid.h"

namespace montelux::python {

// A picture from a file (str or path), or from an array of shape (h, w) or (h, w, 3): floats are linear,
// uint8 is in sRGB. Errors begin with `what`.
Image picture_of(const nb::object& given, const std::string& what);
// Its channels R, G, B (or three times Y) only, linear.
Image rgb_image(const Image& picture, const std::string& what);
// The same for an environment map; throws Error for negative or non-finite pixels.
Image light_map(const nb::object& given, const std::string& what);
// 'equirectangular', 'equal-area', or 'auto', by the shape of the map. Throws Error beginning with `what`.
EnvironmentLayout map_layout(std::string_view name, const Image& map, const std::string& what);
// An array on channels [first, first + count) of a 32-bit picture, which it keeps alive: shape (h, w, count),
// or (h, w) for one. No copy; read-only.
nb::object channels_of(const std::shared_ptr<const Image>& image, int first, int count);

} // namespace montelux::python
