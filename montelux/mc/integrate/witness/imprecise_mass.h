// The part of an integral where values have lost their digits by cancellation.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/integrate/evaluator.h"

namespace montelux {

// What rounding may lose of the integral of each g_c: the integral of its rounding error where it is precise to two digits,
// and of all |g_c| elsewhere, since what lies closer to a point where digits end is of the order of what lies before it. Values
// that are zero by rounding count as others that lost their digits. By 4096 points, half of them uniform, the others at
// distances of all scales: from ends, centre, origin and landmarks in each variable by itself, and from corners in all together,
// since products are small near faces. These evaluations are not counted. Empty where the integrand does not know its rounding,
// and for more than 64 variables.
std::vector<double> imprecise_mass(const Evaluator& evaluator, std::span<const std::vector<double>> landmarks,
                                   std::uint64_t seed);

} // namespace montelux
