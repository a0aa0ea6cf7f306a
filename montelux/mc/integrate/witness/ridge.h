// Ridges that lead out to infinity, as that of exp(-(x - y)^2) over the plane.
#pragma once

#include <span>

#include "montelux/mc/integrate/witness/peak.h"

namespace montelux {

// Whether a point of the cube is far out along a variable of infinite range. There ridges look like poles.
bool is_far_out(const Domain& domain, std::span<const double> u);

// Whether the integral along a ridge through a point that is far out does not fall from scale to scale: follows it back
// towards the centre, along the line that keeps the ratios of the variables that are far out, climbs to the ridge and
// measures its width at each scale. False in one variable, and where there is no ridge at some scale. About 350 n
// evaluations.
bool ridge_diverges(RawValues& raw, const std::vector<double>& u, const Magnitude& magnitude);

} // namespace montelux
