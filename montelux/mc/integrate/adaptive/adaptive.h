// Adaptive integration (A10): a trained mixture density, sampled by randomised Sobol' points.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "montelux/mc/integrate/estimator.h"

namespace montelux {

// 1. Explores with uniform scrambled Sobol' points, 16 x 256 at first in several variables. Where these alone
//    will reach the target soon (smooth, flat or oscillating integrands), they continue, on plateaus to 16384
//    at least.
// 2. Otherwise trains a mixture density. Where the values are uneven, peaks are searched for by climbing the
//    logarithm of |f|. Rounds of importance sampling then fit a product of one-dimensional maps (Lepage 1978)
//    and Gaussians, and add Gaussians at the points with the largest weights, until the weights are even and
//    cover what was seen, or a share of the expected cost is spent.
// 3. Samples that density, frozen, in independent replicates of scrambled Sobol' points. Their mean is the
//    estimate, unbiased since the training does not enter it, and their spread is its error (Student's law
//    with replicates - 1 degrees of freedom), raised where few values make up the variance. Where weights
//    appear that the density did not promise, the samples are given up and the training continues. Where
//    uniform points prove to have the smaller error, they continue instead.
// A share of all points stays uniform, so that the weights are bounded by f times its inverse.
// Warnings: weights with a heavy tail, training rounds that disagree with the result, too few points that saw
// anything.
struct Adaptive {
    static constexpr std::string_view name = "adaptive";

    int replicates = 16;            // at least 4
    double uniform_share = 1 / 16.; // of the points, at least; in (0, 1)
    double training_share = 0.25;   // of the evaluations that the target is expected to need; in (0, 1)

    // At most 1024 dimensions.
    std::unique_ptr<Estimator> estimator(const Problem& problem) const;
};

} // namespace montelux
