// Gradient noise of Perlin 2002.
#pragma once

#include "montelux/mc/math/vec.h"

namespace montelux {

// Perlin 2002, "Improving Noise", with the permutation of his reference program: smooth, about within [-1, 1],
// 0 at all points of integers, of period 256.
float gradient_noise(Point3f p);

// Its gradient by forward differences over 0.01, as in pbrt-v4.
Vec3f gradient_noise_slope(Point3f p);

} // namespace montelux
