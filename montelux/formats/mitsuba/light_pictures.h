// Pictures of a Mitsuba scene for its lights: on surfaces, projected, and of the environment.
#pragma once

#include "montelux/formats/mitsuba/plugin.h"
#include "montelux/image/image.h"
#include "montelux/scene/light/picture_lookup.h"

namespace montelux::mitsuba {

// Of the file that a property of `owner` names: R, G and B, linear.
Image picture_in_file(Plugin& owner, std::string_view property);

struct LightPicture {
    Image image;
    PictureLookup lookup = PictureLookup::bilinear;
};

// A texture 'bitmap' as the picture that its coordinates (u to the right, v down) show on the unit square. Its to_uv
// must map the square onto itself; an Error for others, and for other textures.
LightPicture picture_of_texture(Plugin texture);

// An environment map in the layout of our latitude-longitude maps: the rows of Mitsuba's begin and end at the poles.
Image environment_rows(const Image& map);

} // namespace montelux::mitsuba
