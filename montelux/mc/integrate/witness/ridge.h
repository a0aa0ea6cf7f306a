// Ridges that lead out to infinity, as that of exp(-(x - y)^2) over the plane.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/integrate/witness/peak.h"

namespace montelux {

// Whether a point of the cube is far out along a variable of infinite range. There ridges look like poles.
bool is_far_out(const Domain& domain, std::span<const double> u);

// Whether the integral along a ridge through a point that is far out does not fall from scale to scale: follows it back
// towards the centre, along the line that keeps the ratios of the variables that are far out, climbs to the ridge and
// measures its width at each scale. False in one variable, and where there is no ridge at some scale. About 350 n
// evaluations.
bool ridge_diverges(RawValues& raw, const std::vector<double>& u, const Magnitude& magnitude);

// A ridge along which a guide is zero, followed from a point of it towards an end of variable d.
struct RidgeToEnd {
    std::vector<Witness> tops; // at each octave of the distance; each speaks for its part of the ridge
    double beyond = 0;         // mass closer to the end than doubles resolve, in units of the last one's
    bool diverges = false; // masses do not fall towards an infinite end, as far as doubles resolve the ridge
};
// `least`: mass at which it ends; `most_evaluations`, after which no further scale is begun. About 20 n at each scale,
// and 20 n at as many scales again where the masses hardly fall.
RidgeToEnd follow_ridge(RawValues& raw, const Integrand::BatchFunction& guide,
                        const std::vector<double>& from, std::size_t d, double side,
                        const Magnitude& magnitude, double least, std::uint64_t most_evaluations);

// Whether the magnitude is greater close to a measured point than there, so that it is on no ridge.
bool is_valley(RawValues& raw, const Witness& top, const Magnitude& magnitude);

} // namespace montelux
