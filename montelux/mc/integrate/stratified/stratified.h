// Stratified sampling (A5): a grid of strata, jittered, with proportional or optimal allocation.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "montelux/mc/integrate/estimator.h"

namespace montelux {

enum class Allocation : std::uint8_t {
    // As many samples in each of the (equal) strata: the variance is never above basic Monte Carlo's.
    proportional,
    // n_k in proportion to the standard deviation within stratum k (Neyman 1934, "On the two different
    // aspects of the representative method"), as a pilot estimates it. The pilot only decides the allocation
    // and does not enter the estimate, which stays unbiased; a fifth of the samples is spread evenly, for
    // strata that the pilot misjudged.
    neyman
};

// The unit cube is divided into a grid of strata; the estimate is the sum of volume times mean over strata,
// its error the sum of volume^2 s^2 / n, each from at least two samples. By default (strata = 0) the grid is
// the finest that the samples of a pass allow with two per stratum, so that the error of a smooth integrand
// in n dimensions falls as N^(-1/2 - 1/n): as 1/N in two. With a pilot there are about 16 per stratum, so
// that allocation matters; also in one dimension, where a jump lies in a single stratum that decides the
// error, and two samples would mostly miss it. (16 still miss one close to an end of its stratum: the error
// of a jump in one dimension is the least reliable.)
//
// One pass takes all allowed evaluations, up to a million; with an error target, passes double. Passes are
// averaged with weights N^(1 + 2/n) that are fixed beforehand (for a grid that is given: N).
struct Stratified {
    static constexpr std::string_view name = "stratified";
    static constexpr FirstLookUse first_look = FirstLookUse::with_target;

    std::uint64_t strata = 0; // along each variable
    Allocation allocation = Allocation::proportional;
    int pilot = 4; // samples in each stratum, for Neyman's allocation; at least 2

    std::unique_ptr<Estimator> estimator(const Problem& problem) const;
};

} // namespace montelux
