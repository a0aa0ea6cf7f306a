// Strategy pictures: what each strategy of bidirectional path tracing brings to a picture.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "montelux/mc/math/vec.h"
#include "montelux/render/renderer.h"

namespace montelux {

struct StrategyPicture {
    // Vertices on the light's and on the camera's side; the path has s + t.
    std::size_t s = 0, t = 0;
    // Linear sRGB of the film's pixels, row by row: of the paths weighted among the strategies that find them, and as if
    // the strategy were the only one.
    std::vector<Vec3f> weighted, unweighted;
};

// Of all strategies that found a path, by s + t and then by s. They see the samples of the renderer's picture, so the
// weighted ones sum to that but for rounding, and but for the film's limit, which is left out. The pictures are the same
// for any number of threads. Empty if `stop`, which any thread asks now and then, returns true.
//
// Veach 1997, "Robust Monte Carlo Methods for Light Transport Simulation", figure 10.2.
//
// Throws Error unless the integrator traces light, without merging, the scene has no media, max_depth is at most
// most_strategy_depth, and the pictures take at most 4 GiB.
std::vector<StrategyPicture> strategy_pictures(const Renderer& renderer,
                                               const std::function<bool()>& stop = {});
inline constexpr int most_strategy_depth = 12;

} // namespace montelux
