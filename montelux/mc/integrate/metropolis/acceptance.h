// Acceptance probabilities of Metropolis-Hastings.
#pragma once

#include <algorithm>
#include <cmath>

namespace montelux {

// Hastings 1970, "Monte Carlo Sampling Methods Using Markov Chains and Their Applications": the proposal y from
// q(y | x) is accepted with probability min(1, p(y) q(x | y) / (p(x) q(y | x))), of whose quotient this is the
// logarithm. -infinity where p(y) is 0.
inline double acceptance_of_log_ratio(double log_ratio) { return std::exp(std::min(0.0, log_ratio)); }

// Of a symmetric proposal (Metropolis, Rosenbluth, Rosenbluth, Teller, Teller 1953), from densities at the current
// state, which is positive, and at the proposed one.
inline double acceptance_of_densities(double current, double proposed) {
    return proposed < current ? proposed / current : 1;
}

} // namespace montelux
