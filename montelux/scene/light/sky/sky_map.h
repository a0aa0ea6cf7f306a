// The sky as a picture of latitude and longitude.
#pragma once

#include "montelux/image/image.h"
#include "montelux/scene/light/sky/sky_model.h"

namespace montelux {

// Width 2 height, in EnvironmentLayout::equirectangular: +z at the top, azimuth from +x at the left towards
// +y. Channels R, G and B all contain the mean radiance over the visible wavelengths, W/(m^2 sr nm), at the
// centre of each texel, without the sun's disc: the density for sampling directions.
Image sky_density_map(const SkyModel& sky, int height);

// The same layout in linear sRGB with luminance in cd/m^2, the mean of each texel. The sun's light is
// distributed over the texels of its disc, so its irradiance is that of the disc.
Image sky_picture(const SkyModel& sky, int height, bool with_sun);

} // namespace montelux
