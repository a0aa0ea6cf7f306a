// Multiple importance sampling (A7): several techniques for one integral, combined by weights.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <variant>
#include <vector>

#include "montelux/mc/integrate/estimator.h"
#include "montelux/mc/integrate/mis.h"
#include "montelux/mc/integrate/techniques/technique.h"

namespace montelux {

// A technique and its samples in each round: technique i gets n_i samples of every sum of n.
struct WeightedTechnique {
    Technique technique;
    std::uint64_t samples = 1;
};

// The weights of least variance for any number of samples (Kondapaneni, Vevoda, Grittmann, Skrivan,
// Slusallek, Krivanek 2019, "Optimal Multiple Importance Sampling"); they may be negative.
struct OptimalWeights {};

// F = sum over techniques i of 1/n_i * sum over j of w_i(X_ij) f(X_ij) / p_i(X_ij), X_ij ~ p_i (Veach 1997,
// eq. 9.4). The densities must be in one measure; wherever f != 0 at least one must be above zero, and the
// estimate is then unbiased for every heuristic. Each technique's inner sum is divided by its own n_i. The
// square of the error adds the variances of the techniques, which are independent.
//
// With OptimalWeights the estimate is
//     sum_k alpha_k + sum_i sum_j (f(X_ij) - sum_k alpha_k p_k(X_ij)) / sum_k n_k p_k(X_ij),
// eq. 16 there: the densities, whose integrals are 1, are control variates for the balance heuristic. alpha
// solves A alpha = b (one b for each component of f), with A_ik = integral of p_i p_k / sum n p and b_i =
// integral of f p_i / sum n p, estimated from the samples of all steps before; so every step is unbiased
// whatever alpha is, the steps are uncorrelated, and they are averaged by their numbers of samples. The first
// step is a pilot for alpha. If A is singular (identical techniques) alpha is one of its solutions.
//
// A small part of the evaluations probes uniform points of the domain for places where f != 0 and all
// densities are zero (see Importance).
struct MultipleImportance {
    static constexpr std::string_view name = "multiple_importance";

    std::vector<WeightedTechnique> techniques;
    std::variant<MisHeuristic, OptimalWeights> weights = MisHeuristic::balance();
    bool probes = true;

    // Throws Error without a technique that draws samples, and where dimensions differ.
    std::unique_ptr<Estimator> estimator(const Problem& problem) const;
};

} // namespace montelux
