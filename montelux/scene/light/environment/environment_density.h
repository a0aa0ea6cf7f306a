// Common to the densities over an environment map: their samples, and the light that they follow.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "montelux/image/image.h"
#include "montelux/scene/light/environment/environment_grid.h"

namespace montelux {

// A position on the map, and its density per solid angle.
struct EnvironmentPoint {
    Vec2f grid;
    float pdf = 0;
};

// Rounding must not move a sampled position out of its texel.
inline Vec2f keep_in_texel(Vec2f grid, std::uint32_t column, std::uint32_t row) {
    return {std::min(grid.x, std::nextafter(static_cast<float>(column + 1), 0.0f)),
            std::min(grid.y, std::nextafter(static_cast<float>(row + 1), 0.0f))};
}

// The mean of R, G and B; negative values count as 0.
double texel_radiance(const Image& map, std::size_t texel);
// Light of each texel, row by row: radiance times solid angle. Positive wherever a channel is.
std::vector<float> texel_light(const Image& map, const EnvironmentGrid& grid);
double sum_of(const std::vector<float>& light);
// The same for bilinearly interpolated maps, from the light of individual texels. Positive wherever the texel
// is not black.
std::vector<float> blended_light(const std::vector<float>& light, const EnvironmentGrid& grid);

// The light minus that of a uniform sky of its mean radiance, clamped to 0: Karlik et al. 2019, "MIS
// Compensation: Optimizing Sampling Techniques in Multiple Importance Sampling", for one sample of the map
// and one of the BSDF, which is uniform when averaged over normals. If less than 1 % is left, as for nearly
// constant maps, the light is unchanged, and the result is false.
bool compensate(std::vector<float>& light, const EnvironmentGrid& grid);

} // namespace montelux
