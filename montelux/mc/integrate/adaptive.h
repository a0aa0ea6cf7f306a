// Adaptive integration (A10): a trained mixture density, sampled by randomised Sobol' points.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "montelux/mc/integrate/estimator.h"

namespace montelux {

// 1. Explores with uniform scrambled Sobol' points. Where these alone will reach the target soon (smooth,
// flat
//    or oscillating integrands), they go on.
// 2. Otherwise trains a mixture density: where only few points saw anything, peaks are searched for by
// climbing
//    the logarithm of |f|; then rounds of importance sampling fit a product of one-dimensional maps (as VEGAS
//    has, Lepage 1978) and Gaussians, until the weights are even or a share of the expected cost is spent.
// 3. Samples that density, frozen, in independent replicates of scrambled Sobol' points; their mean is the
//    estimate, unbiased since the training does not enter it, and their spread is its error (Student's law
//    with replicates - 1 degrees of freedom). Where uniform points prove to have the smaller error, they are
//    continued instead.
// A share of all points stays uniform, so that the weights are bounded by f times its inverse.
// Doubts: weights with a heavy tail, training rounds that disagree with the result, too few points that saw
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
