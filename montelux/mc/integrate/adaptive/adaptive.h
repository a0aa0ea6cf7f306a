// Adaptive integration (A10): a trained mixture density, sampled by randomised Sobol' points.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "montelux/mc/integrate/estimator.h"

namespace montelux {

// 1. Explores with uniform scrambled Sobol' points, 16 x 256 at first in several variables. If these alone
//    will reach the target soon (smooth, flat or oscillating integrands), they continue; on plateaus to at
//    least 16384.
// 2. Otherwise trains a mixture density. If the values are uneven, it first climbs log |f| to find peaks.
//    Rounds of importance sampling then fit a product of one-dimensional maps (Lepage 1978) and Gaussians,
//    and add Gaussians at the points with the largest weights, until the weights are even and cover all
//    points seen, or a share of the expected cost is spent.
// 3. Samples that density, frozen, in independent replicates of scrambled Sobol' points. Their mean is the
//    estimate, unbiased since the training does not enter it, and their spread is its error (Student's law
//    with replicates - 1 degrees of freedom), raised if few values contribute to the variance. If
//    unexpectedly large weights appear, the samples are discarded and the training continues. If uniform
//    points prove to have the smaller error, they continue instead.
// A share of all points stays uniform, so that the weights are bounded by f times its inverse. Warnings:
// weights with a heavy tail, training rounds that disagree with the result, too few non-zero points.
struct Adaptive {
    static constexpr std::string_view name = "adaptive";
    static constexpr FirstLookUse first_look = FirstLookUse::always;
    static constexpr bool on_device = true; // draws there what training does not get

    int replicates = 16;            // at least 4
    double uniform_share = 1 / 16.; // minimum share of the points; in (0, 1)
    double training_share = 0.25;   // of the evaluations that the target is expected to need; in (0, 1)

    // At most 1024 dimensions.
    std::unique_ptr<Estimator> estimator(const Problem& problem) const;
};

} // namespace montelux
