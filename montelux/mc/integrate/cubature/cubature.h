// Deterministic adaptive integration: halves the regions of the largest errors until the sum of errors
// reaches the target.
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
// Errors are not standard deviations: each is the sum over the regions of the null rules' errors, meant to be
// above the true error rather than near it. Added to these are
// - surprises of points close to the faces of a region, and the difference of two halves at the face between
//   them (a jump at the face),
// - a quarter of the difference between a region and its halves,
// - a factor 1 + 8 / regions, since few regions have tested one another yet (for the 13 points of one
//   variable: twice the error of its 7 over the claimed one, if that is less),
// - the factor by which errors of recently halved regions were too small, if they were, and
// - the same factor of a random sample of all regions, which is halved before a result that reaches its target is
//   believed (two variables and more; CubatureConfirmation).
// A result that reaches its target is checked by random points: three fifths of them spread over the regions
// by volume, the others where values vary and equally over the regions. If a value is far from the values of
// its region's rule, or the mean of the points from the rules' value, regions are halved and checked again. A
// part of the unit cube of volume v with unexpected values is overlooked with a probability of at most about
// exp(-0.6 check_points v). The seed only affects these points.
struct Cubature {
    static constexpr std::string_view name = "cubature";
    static constexpr FirstLookUse first_look = FirstLookUse::always;
    static constexpr int max_dimensions = 15;

    // Bytes that the regions may take; the integration ends with a warning when they are used up.
    std::uint64_t max_memory = std::uint64_t{1} << 28;
    // Random points of each check; four times as many if all values seen are similar; where the integrand has jumps,
    // up to five times as many for targets below 5e-4 (2 / relative error). 0: neither check nor confirmation.
    // Default: 128 in one variable, 4096 in more.
    std::optional<std::uint64_t> check_points = std::nullopt;

    // Throws Error for more than max_dimensions variables, and for memory that does not hold 64 regions.
    std::unique_ptr<Estimator> estimator(const Problem& problem) const;
};

} // namespace montelux
