// Recursive stratified sampling (A5): boxes that are halved where the integrand varies most.
#pragma once

#include <memory>
#include <string_view>

#include "montelux/mc/integrate/estimator.h"

namespace montelux {

// In the spirit of MISER (Press and Farrar 1990, "Recursive Stratified Sampling for Multidimensional Monte
// Carlo Integration"): a pilot shows the variances in both halves of a box along each variable; the box is
// halved along the variable for which sigma_a^(2/3) + sigma_b^(2/3) is least, and its samples are divided as
// sigma^(2/3), the optimum if the variance of a part falls as the square of its samples. Unlike MISER, a half
// inherits its pilot points, so that one pilot of `pilot` of all evaluations serves most of the tree and new
// points are drawn only where samples gather; deviations are used, not ranges; and no half gets less than a
// tenth. Boxes with few samples are not halved.
//
// The pilot only decides the boxes and their numbers of samples: the estimate, the sum over boxes of volume
// times mean, is unbiased, and so is the square of its error. Passes of at most a million evaluations, as in
// Stratified, are averaged with weights N^(1 + 2/n) that are fixed beforehand.
struct Recursive {
    static constexpr std::string_view name = "recursive";
    static constexpr FirstLookUse first_look = FirstLookUse::with_target;

    double pilot = 0.1; // part of the evaluations, in [0.01, 0.5]

    std::unique_ptr<Estimator> estimator(const Problem& problem) const;
};

} // namespace montelux
