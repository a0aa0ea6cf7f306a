// Random walkers that follow a function to places that importance sampling has not reached.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/integrate/adaptive/mode_search.h"
#include "montelux/mc/integrate/points.h"

namespace montelux {

struct DifferenceWalk {
    std::uint64_t key = 0; // of the random numbers
    std::size_t walkers = 64;
    std::size_t steps = 32;
    double exponent = 1; // of h; below 1, walkers cross from peak to peak and go far into tails
};

// Points on the unit cube, with h at each; the last `walkers` of them are the walkers' positions.
struct WalkedPoints {
    PointBuffer x;
    std::vector<double> h;
    double exponent = 1;
};

// Metropolis walkers with density h^exponent, whose proposals are differences of two other walkers (ter Braak 2006, "A
// Markov Chain Monte Carlo version of the genetic algorithm Differential Evolution"), of all coordinates or
// some, or that move along the line through a third one (the snooker update of ter Braak and Vrugt 2008,
// "Differential Evolution Markov Chain with snooker updater and fewer chains"): they take the shape of a ridge
// without a fit. They start at points drawn by weight, and cost walkers * steps evaluations.
WalkedPoints walk_by_differences(const DensityFunction& h, const PointBatch& x,
                                 std::span<const double> h_at_x, std::span<const double> weights,
                                 const DifferenceWalk& settings);

} // namespace montelux
