// DrawSummary: mean, error and convergence of one variable from the draws of several chains.
#pragma once

#include <cstddef>
#include <span>

namespace montelux {

// The diagnostics of Vehtari, Gelman, Simpson, Carpenter, Buerkner 2021, "Rank-Normalization, Folding, and
// Localization: An Improved R-hat for Assessing Convergence of MCMC".
struct DrawSummary {
    double mean = 0, standard_error = 0;
    double standard_deviation = 0; // of a single draw
    // The larger of the split R-hats of rank-normalised draws and of their rank-normalised distances from the median;
    // 1 when halves of chains agree as draws of one density do. Infinite, as the error is, below eight draws of a chain
    // and where all draws are equal: chains that never moved tell nothing.
    double r_hat = 1;
    // As many independent draws are worth the same, for the centre of the distribution (of rank-normalised draws) and
    // for its 5 % and 95 % quantiles (the smaller of the two).
    double bulk_effective_size = 0, tail_effective_size = 0;
};

// `values`: the draws of chain 0, then those of chain 1, and so on. Chains [0, walkers), [walkers, 2 walkers), ... are
// walkers of one ensemble: these are independent at one time, but not of one another's past. Effective sizes and
// errors are therefore those of the series of the ensembles' means (Goodman and Weare 2010, section 3), R-hat that of
// single walkers, each of which must have seen the whole density. With walkers = 1 all is as in the paper.
DrawSummary summarize_draws(std::span<const double> values, std::size_t chains, std::size_t walkers = 1);

} // namespace montelux
