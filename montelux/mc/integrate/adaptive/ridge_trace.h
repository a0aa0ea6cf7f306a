// Traces of ridges: points along a crest, on beyond those that importance sampling has reached.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/integrate/adaptive/mode_search.h"
#include "montelux/mc/integrate/points.h"

namespace montelux {

struct TracedPoints {
    PointBuffer x;
    std::vector<double> h;
};

// Follows h on the unit cube from two points with the largest ratio h / p, the ends of what the points x reach, to
// both sides: along the principal axis of the surrounding points at first, then along the crest itself, by the best of
// some points around the place where it should go on. Ends where h is negligible, at the cube's faces, and after
// max_evaluations.
TracedPoints trace_ridge(const DensityFunction& h, const PointBatch& x, std::span<const double> h_at_x,
                         std::span<const double> ratios, std::uint64_t key, std::uint64_t max_evaluations);

} // namespace montelux
