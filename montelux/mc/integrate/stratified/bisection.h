// A division of the unit cube into boxes, found by recursive bisection after a pilot.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "montelux/mc/integrate/estimator.h"
#include "montelux/mc/integrate/stratified/strata.h"

namespace montelux {

// Boxes by their corners, d numbers each, and how many samples they get.
struct Bisection {
    std::vector<double> lower, width;
    std::vector<std::uint64_t> offsets; // of the samples, one more than boxes
    std::uint64_t pilot = 0;            // evaluations made to find it
    NonFiniteCount non_finite;

    // Refers to this.
    Strata strata() const;
};

// Bisects for `samples` evaluations in all, of which about `pilot_part` are pilots; the streams of random
// numbers are (seed, stream) and on. Empty when cancelled. See Recursive.
std::optional<Bisection> bisect(const Problem& problem, std::uint64_t samples, double pilot_part,
                                std::uint32_t stream, const CancelFlag* cancel);

} // namespace montelux
