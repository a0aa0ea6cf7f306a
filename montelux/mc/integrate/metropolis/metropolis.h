// Metropolis-Hastings as a method of integration (A8): the mean over a chain times the chain's normalisation.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "montelux/mc/integrate/estimator.h"

namespace montelux {

// Chains of random walks draw points of density s(u) / Z on the unit cube, where s is the size of the
// integrand g (|g|, or for vectors the root of the sum of squares, each component relative to its root mean
// square), and Z, the integral of s, is unknown to them. Then
//     integral of g_c = Z * (mean of g_c / s over the chains).
// Z comes from importance sampling with points of their own: a mixture of nine parts of a multivariate
// Student density (4 degrees of freedom, mean and covariance of the chains' burn-in, which is then discarded)
// and one part uniform, so that no weight exceeds 10 s. The estimate of Z is unbiased; that of the mean is
// consistent, since chains forget their starts only in time; the two are independent, and so
//     variance = Z^2 variance(mean) + mean^2 variance(Z).
// If g never changes sign the mean is exactly 1 or -1, and the chains only fit the importance density.
//
// Starts are drawn in proportion to s from a uniform pilot. The split R-hat over chains (of the means, of log
// s and of coordinates) above 1.01 gives a warning: the weights of separate peaks are then not known. For
// expectations under a user's density see metropolis() in metropolis_chain.h.
struct Metropolis {
    static constexpr std::string_view name = "metropolis";

    int chains = 32;
    // Discarded states at the start of each chain.
    std::uint64_t burn_in = 500;
    // Uniform points among which the starts are chosen.
    std::uint64_t pilot = 4096;

    // Throws Error for settings out of range, and for more than 256 dimensions.
    std::unique_ptr<Estimator> estimator(const Problem& problem) const;
};

} // namespace montelux
