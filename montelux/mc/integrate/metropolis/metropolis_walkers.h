// The chains of the method Metropolis: random walks in lockstep, with proposals evaluated together.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "montelux/mc/integrate/estimator.h"
#include "montelux/mc/integrate/metropolis/chain_trace.h"
#include "montelux/mc/stats/covariance_moments.h"

namespace montelux {

// One chain: where it is, the size s there, and g / s.
struct WalkingChain {
    std::vector<double> u, mean;
    double size = 0;
};

struct WalkCounts {
    std::uint64_t evaluations = 0, accepted = 0, proposed = 0;
    NonFiniteCount non_finite;

    void merge(const WalkCounts& later) {
        evaluations += later.evaluations;
        accepted += later.accepted;
        proposed += later.proposed;
        non_finite.merge(later.non_finite);
    }
};

// Returns the size s of the integrand at point i that Metropolis defines, and fills `mean` with g / s.
double component_ratios(const ValueBuffer& g, std::size_t i, const std::vector<double>& inverse_scale,
                        std::vector<double>& mean);

struct Walkers {
    std::vector<WalkingChain> chains;
    std::vector<ChainTrace> traces; // of the chains
    std::vector<double> inverse_scale;
    // A proposal is u + step * L z, z standard normal; L row by row. Symmetric.
    std::vector<double> factor;
    double step = 0;

    // What is traced: g_c / s, then log s, then the first coordinates.
    static int observables(const Evaluator& g);
    // Moves all chains by this many states. Traces them or, in a window of the burn-in (from 1), appends
    // their points to `seen`. (number, window) keys the random numbers. Empty when cancelled; the chains are
    // then unusable.
    std::optional<WalkCounts> walk(const Problem& problem, std::uint64_t states, std::uint32_t number,
                                   std::uint32_t window, CovarianceMoments* seen, const CancelFlag* cancel);

  private:
    void walk_group(const Problem& problem, std::size_t first, std::uint64_t states, std::uint32_t number,
                    std::uint32_t window, CovarianceMoments* seen, WalkCounts& counts);
};

} // namespace montelux
