// ChainWeights: how states of a Metropolis chain and independent samples share an integral.
#pragma once

namespace montelux {

// The integral of F over the unit cube from two kinds of points: states of chains whose density is f / b, where b is
// the integral of f, and independent uniform points (large steps, and the points that the chains start from).
// Multiple importance sampling by the balance heuristic, where f / c stands for the unknown density: each point x
// contributes
//
//     F(x) w(x),  w(x) = 1 / (N f(x) / c + n),
//
// times b'/c if it is a state of a chain, where b' is the mean of f over the points among which the chain's start was
// chosen in proportion to f. N: number of chain states; n: expected number of uniform points.
//
// Unbiased for any c > 0 that does not depend on these points, for any number of states, and before the chain has
// converged: E[b' g(x_t)] is the integral of f g for every t (Veach 1997, "Robust Monte Carlo Methods for Light
// Transport Simulation", section 11.3.1). Kelemen et al. 2002, section 3.4, weight large steps alike, with c = b' from
// the same points, which is biased.
struct ChainWeights {
    double states_over_scale = 0;   // N / c; 0: chains contribute nothing
    double independent_samples = 1; // n

    double operator()(double f) const { return 1 / (states_over_scale * f + independent_samples); }
};

} // namespace montelux
