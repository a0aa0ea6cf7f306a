// FoundPath: a path that a strategy of BidirectionalIntegrator found, for tests and pictures of strategies.
#pragma once

#include <cstddef>
#include <span>

#include "montelux/mc/math/vec.h"
#include "montelux/spectrum/sampled_spectrum.h"
#include "montelux/transport/light_end.h"
#include "montelux/transport/light_map.h"
#include "montelux/transport/strategy_weight.h"
#include "montelux/transport/subpath.h"

namespace montelux {

// Its first s vertices are of the light's side, the other t of the camera's. Of a merged path (s + t vertices, merged
// at v_s) the light's vertices are those of a LightMap.
struct FoundPath {
    std::size_t s = 0, t = 0;
    const LightEnd& end;                   // v_0
    std::span<const SubpathVertex> light;  // v_1 to v_{s-1}
    std::span<const SubpathVertex> camera; // v_{n-2} and so on, to v_s (v_1 for s = 0)
    Point3f lens;                          // v_{n-1}
    const PathDensities& densities;
    double weight = 0;
    SampledSpectrum value;                  // unweighted
    const LightMapVertex* merged = nullptr; // at v_s, if that is merged
    const Point2f* film = nullptr;          // of a splat: where it lies, in pixels
};

struct PathObserver {
    void (*found)(void* self, const FoundPath& path);
    void* self;
};

} // namespace montelux
