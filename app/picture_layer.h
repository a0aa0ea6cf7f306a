// One layer of a picture, by the name of the layer or of its channels.
#pragma once

#include <string>

#include "montelux/image/image.h"

namespace montelux::app {

struct PictureLayer {
    Image image;               // R, G, B or Y
    bool is_direction = false; // of unit vectors
};

// `name`: as in --layers, or what the names of one or three channels begin with. Throws Error, which lists the layers
// that there are, for others. `file` is for messages.
PictureLayer layer_of(const Image& image, const std::string& name, const std::string& file);

} // namespace montelux::app
