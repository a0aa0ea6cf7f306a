// The sky as a picture of latitude and longitude.
#pragma once

#include "montelux/image/image.h"
#include "montelux/scene/light/sky/sky_model.h"

namespace montelux {

// Width 2 height, in EnvironmentLayout::equirectangular: +z at the top, azimuth from +x towards +y beginning
// at the left. Channels R, G and B all hold the mean radiance over the visible wavelengths, W/(m^2 sr nm), at
// the middle of each texel, without the sun's disc: what directions are drawn by.
Image sky_density_map(const SkyModel& sky, int height);

// The same layout in linear sRGB, whose luminance is in cd/m^2, the mean of each texel. The sun's light is
// spread over the texels that its disc meets, so that what it gives is what the disc gives.
Image sky_picture(const SkyModel& sky, int height, bool with_sun);

} // namespace montelux
