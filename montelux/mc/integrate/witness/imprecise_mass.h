// The part of an integral where values have lost their digits by cancellation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/integrate/evaluator.h"

namespace montelux {

// Upper estimate of what rounding loses of the integral of each g_c:
// - the rounding error itself where it is at most 1 % of |g_c|,
// - all of |g_c| elsewhere, since towards a pole about as much is lost as the imprecise values nearby hold,
// - where g_c is zero by rounding, the mean of imprecise values (else, of all), at most the rounding error.
// Half of the points, in batches of 256, are uniform. The others have distances of all scales from ends, centre, origin and
// landmarks in each variable, or from a corner in all variables, since products are small near faces.
// Returns an empty vector if the integrand has no rounding function, beyond 64 variables, or for fewer than 256 points.
std::vector<double> imprecise_mass(const Evaluator& evaluator, std::span<const std::vector<double>> landmarks,
                                   std::uint64_t seed, std::size_t points = 4096);

} // namespace montelux
