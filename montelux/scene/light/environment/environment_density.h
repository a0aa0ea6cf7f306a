// What the densities over an environment map have in common: their samples, and the light that they follow.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "montelux/image/image.h"
#include "montelux/scene/light/environment/environment_grid.h"

namespace montelux {

// A place on the map, and the density over solid angle with which it is drawn.
struct EnvironmentPoint {
    Vec2f grid;
    float pdf = 0;
};

// A place that was drawn in a texel and rounded stays in it.
inline Vec2f keep_in_texel(Vec2f grid, std::uint32_t column, std::uint32_t row) {
    return {std::min(grid.x, std::nextafter(static_cast<float>(column + 1), 0.0f)),
            std::min(grid.y, std::nextafter(static_cast<float>(row + 1), 0.0f))};
}

// The mean of R, G and B, with what is negative taken for 0.
double texel_radiance(const Image& map, std::size_t texel);
// Light of each texel, row by row: its radiance times its solid angle. Above zero wherever a channel is.
std::vector<float> texel_light(const Image& map, const EnvironmentGrid& grid);
double sum_of(const std::vector<float>& light);
// The same for maps that are looked up bilinearly, from the light of texels that are looked up alone. Above
// zero wherever something shines in the texel.
std::vector<float> blended_light(const std::vector<float>& light, const EnvironmentGrid& grid);

// The light less that of a sky of its mean radiance, where that leaves something: Karlik et al. 2019, "MIS
// Compensation: Optimizing Sampling Techniques in Multiple Importance Sampling", for one sample of the map
// beside one of the BSDF, which normals all over the sphere make uniform. Where less than 1 % is left, as of
// maps that are constant, it stays what it is, and false is returned.
bool compensate(std::vector<float>& light, const EnvironmentGrid& grid);

} // namespace montelux
