// Means of an environment map over the texels of a cube map: the sharpest level of a chain.
#pragma once

#include <cstdint>

#include "montelux/bake/cube_frame.h"
#include "montelux/bake/environment_map.h"
#include "montelux/bake/texel_estimate.h"
#include "montelux/image/cube_map.h"

namespace montelux {

// Two points in each of n x n parts of the texel, weighted by their solid angle, less the radiance at the
// texel's centre, which is added again: unbiased, and exact where the map is constant. n grows until the goal
// is met.
TexelEstimate estimate_texel_mean(const EnvironmentMap& map, const CubeFrame& frame, const CubeTexel& texel,
                                  int size, const TexelGoal& goal, std::uint64_t key);

} // namespace montelux
