// One layer of a picture, by the name of the layer or of its channels.
#pragma once

#include <cstdint>
#include <string>

#include "montelux/image/image.h"

namespace montelux::app {

enum class LayerValues : std::uint8_t { light, directions, depths };

struct PictureLayer {
    Image image; // R, G, B or Y
    LayerValues values = LayerValues::light;
};

// `name`: as in --layers, or what the names of one or three channels begin with. Throws Error, which lists the layers
// that there are, for others. `file` is for messages.
PictureLayer layer_of(const Image& image, const std::string& name, const std::string& file);

// Makes values that are no light shares of full white: directions (n + 1) / 2, depths from 1 (nearest) to 0 (farthest,
// and where there is no surface).
void scale_for_screen(PictureLayer& layer);

} // namespace montelux::app
