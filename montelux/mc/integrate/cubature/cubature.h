// Deterministic adaptive integration: the regions of the largest errors are halved until the errors add up
// to the target.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "montelux/mc/integrate/estimator.h"

namespace montelux {

// Globally adaptive cubature on the unit cube (Genz & Malik 1980; Berntsen, Espelid & Genz 1991): a rule of
// degree 11 and Kronrod's extension of it in one dimension, degree 13 in two, 11 in three, the Genz-Malik
// rules of degree 7 and 9 in 2 to 15. Best for integrands that are smooth, or piecewise so in few dimensions;
// a region costs 2^n points and more, and jumps or kinks across many variables need more regions than any
// budget allows.
//
// Errors are not standard deviations: each is the sum over the regions of what the null rules of a region
// suspect, meant to be above the true error rather than near it. Above these stand
// - what points close to the faces of a region see that the rule did not expect, and what the halves of a
//   region disagree on at the face between them (a jump at the face),
// - a quarter of what the halves of a region disagree with it by,
// - a factor 1 + 8 / regions, since few regions have not yet tested one another (for one variable's 13 points
//   twice what its 7 were wrong by over what they expected, if that is less), and
// - the factor by which errors of the regions halved of late were too small, where they were.
// No rule is believed on its own word. A result that reaches its target is checked by random points: three
// fifths of them spread over the regions by volume, the others where values vary and equally over the
// regions. Where a value is far from what the rule of its region saw, or the mean of the points from the
// value of the rules, regions are halved and checked again. A part of the unit cube of volume v whose values
// are a surprise is overlooked with a probability of at most about exp(-0.6 check_points v). The seed has an
// effect on these points alone.
struct Cubature {
    static constexpr std::string_view name = "cubature";
    static constexpr int max_dimensions = 15;

    // Bytes that the regions may take; the integration ends with a warning when they are used up.
    std::uint64_t max_memory = std::uint64_t{1} << 28;
    // Random points of each check; four times as many where all values seen are much the same. 0: the rules
    // are believed. Default: 128 in one variable, 4096 in more.
    std::optional<std::uint64_t> check_points = std::nullopt;

    // Throws Error for more than max_dimensions variables, and for memory that does not hold 64 regions.
    std::unique_ptr<Estimator> estimator(const Problem& problem) const;
};

} // namespace montelux
