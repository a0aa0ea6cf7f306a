// Peaks of a non-negative function on the unit cube, found one after the other.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "montelux/mc/integrate/adaptive/gaussian.h"
#include "montelux/mc/integrate/points.h"
#include "montelux/mc/integrate/witness/largest_values.h"

namespace montelux {

struct ModeSearch {
    int most_modes = 24;
    int fruitless = 5;                 // searches in a row that lead to a known mode before the end
    int remote = 3;                    // searches from points far from all modes, although h is small there
    std::uint64_t max_evaluations = 0; // in all
    // Points around the first modes, at scales, which may lead to others that are narrow; and their seed.
    std::uint64_t survey = 0, seed = 0;
    double widest = 0.3;              // largest standard deviation of a Gaussian, of the cube's width
    std::span<const Witness> peaks{}; // known tops with their extents, which come first
};

// h at a batch of points.
using DensityFunction = std::function<void(const PointBatch&, std::span<double>)>;

// Moves x of the unit cube uphill on log h to a place where h is infinite, or to a top; returns log h there.
double climb_to_pole(const DensityFunction& h, std::vector<double>& x, std::uint64_t max_evaluations);

// Climbs log h from points where h is known, each time from the point where h most exceeds the Gaussians of
// the modes found so far, so that a narrow peak among wide ones is found: log h has a slope even where h is
// astronomically small. Each mode gives the Gaussian of its curvature (Laplace's approximation).
std::vector<Gaussian> find_modes(const DensityFunction& h, const PointBatch& x,
                                 std::span<const double> h_at_x, const ModeSearch& settings);

} // namespace montelux
