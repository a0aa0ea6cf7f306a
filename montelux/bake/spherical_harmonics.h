// Diffuse light as nine numbers per channel: order-2 spherical harmonics of an environment map.
#pragma once

#include <array>

#include "montelux/bake/cube_frame.h"
#include "montelux/bake/environment_map.h"

namespace montelux {

// Real orthonormal functions of a unit vector with the signs of Sloan 2008, "Stupid Spherical Harmonics (SH)
// Tricks", without the Condon-Shortley phase: 1, y, z, x, x y, y z, 3 z^2 - 1, z x, x^2 - y^2 times
//   1/2 sqrt(1/pi), sqrt(3/(4 pi)) (three times), 1/2 sqrt(15/pi) (twice), 1/4 sqrt(5/pi), 1/2 sqrt(15/pi),
//   1/4 sqrt(15/pi).
inline constexpr int sh_terms = 9;
std::array<double, sh_terms> spherical_harmonics(Vec3d direction);

struct DiffuseHarmonics {
    using Coefficients = std::array<Vec3d, sh_terms>;

    // integral L Y. What three.js calls SphericalHarmonics3 coefficients.
    Coefficients radiance;
    // integral E Y: radiance times pi, 2 pi / 3, pi / 4 for the three orders (Ramamoorthi and Hanrahan 2001,
    // "An Efficient Representation for Irradiance Environment Maps"). The irradiance at a normal n is the sum
    // of these times Y(n).
    Coefficients irradiance;
    // Irradiance over pi with the constants of the functions multiplied in: c0 + c1 y + c2 z + c3 x + c4 x y
    // + c5 y z + c6 (3 z^2 - 1) + c7 z x + c8 (x^2 - y^2) is the radiance of a white Lambertian surface, as
    // Filament's shaders take it.
    Coefficients polynomial;

    Vec3d irradiance_at(Vec3d normal) const;
};

// In the cube's frame. By Gauss's rule over each texel, in which all functions are smooth: exact compared
// with the precision of the map.
DiffuseHarmonics diffuse_harmonics(const EnvironmentMap& map, const CubeFrame& frame);

} // namespace montelux
