// Textures from formulas: dots, noise and marble, with the constants of pbrt-v4.
#pragma once

#include "montelux/scene/texture/texture.h"

namespace montelux {

// Whether (s, t) is in a dot: a disc of radius 0.35, moved at random within its unit cell.
bool inside_dot(Point2f st);

float noise_value(const NoiseTexture& t, const TextureContext& context);

// Linear sRGB.
Vec3f marble_color(const MarbleTexture& t, const TextureContext& context);

} // namespace montelux
