// Sums of octaves of gradient noise: fractional Brownian motion and turbulence.
#pragma once

#include "montelux/mc/math/vec.h"

namespace montelux {

// Ratio of the frequencies of two octaves; not 2, so that their zeros do not coincide.
inline constexpr float lacunarity = 1.99f;

// Octave i has the frequency lacunarity^i and the weight roughness^i.
struct NoiseOctaves {
    int octaves = 8;
    float roughness = 0.5f;
};

// Number of octaves, not always whole, that a footprint with the sides dpdx and dpdy does not alias: one side
// is at most a quarter of the last period. Musgrave, "Procedural Fractal Terrains"; Pharr, Jakob, Humphreys,
// "Physically Based Rendering" (3rd edition), 10.6.3.
float unaliased_octaves(Vec3f dpdx, Vec3f dpdy, int octaves);

// Sum of octaves. Those that the footprint would alias are replaced by their mean, 0; the last one fades.
float fractal_noise(Point3f p, NoiseOctaves n, Vec3f dpdx = {}, Vec3f dpdy = {});

// The same sum of absolute values; octaves that would alias are replaced by mean_absolute_noise.
float turbulence(Point3f p, NoiseOctaves n, Vec3f dpdx = {}, Vec3f dpdy = {});

// The mean of |gradient_noise|, rounded as in pbrt-v4.
inline constexpr float mean_absolute_noise = 0.2f;

} // namespace montelux
