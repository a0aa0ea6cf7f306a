// Samples of a target from a trained density: weighted, or unweighted by rejection.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "montelux/mc/integrate/trained/target_draws.h"
#include "montelux/mc/stats/estimate.h"

namespace montelux {

// Points x with weights: the mean of a function h over the density f / Z is the sum of weight * h(x) over the
// sum of the weights. f is the first component of the target, Z its integral.
struct Samples {
    PointBuffer x;
    ValueBuffer f; // all components of the target at the points; log f for logarithms
    std::vector<double> weight;
    // Z with its error; for logarithms Z exp(-log_reference). Of unweighted samples: from all draws before the
    // last sample, or from those of the pilot where these are more than the samples asked for.
    Estimate integral;
    double log_reference = 0;
    std::uint64_t draws = 0; // of the density, those outside of the domain included
    std::uint64_t evaluations = 0;
    NonFiniteCount non_finite;
    bool cancelled = false; // or ended by max_draws: fewer samples than asked for
    // Reasons why the samples may not follow f, as sentences.
    std::vector<std::string> warnings;

    std::size_t count() const { return weight.size(); }
    // (sum w)^2 / sum w^2: as many unweighted samples are worth the same.
    double effective_sample_size() const;
};

// n points of the density, those with f = 0 included. The weights f / p are scaled so that they add up to
// `integral`. Throws Error, also for n = 0.
Samples weighted_samples(const TrainedDensity& density, const Integrand& f, std::uint64_t n,
                         const SamplingOptions& options = {});

struct UnweightingOptions : SamplingOptions {
    // Draws whose weights decide the maximum weight.
    std::uint64_t pilot = 32768;
    // The maximum is so low that this share of the integral of |f| lies above it: a few outliers do not spoil
    // the efficiency, and such samples have weights above 1. 0: the largest weight of the pilot.
    double overweight_share = 1e-3;
};

// Samples of |f| by rejection: a draw of weight w is kept with probability min(1, |w| / max_weight) and then
// weighs max(1, |w| / max_weight), with the sign of f. Nearly all weights are 1, or -1; with the others the
// samples follow f exactly, whatever the maximum.
struct UnweightedSamples : Samples {
    double max_weight = 0; // of f / p, in the unit of `integral`
    // Kept draws over all draws, with its standard error.
    Estimate efficiency;
    std::uint64_t overweight = 0; // samples that weigh more than 1,
    double largest_weight = 1;    // the largest weight,
    double overweight_share = 0;  // and what is beyond 1 in all of them, as a share of the sum of |weights|
};

// n samples by rejection. Throws Error where f is zero at all points of the pilot.
UnweightedSamples unweighted_samples(const TrainedDensity& density, const Integrand& f, std::uint64_t n,
                                     const UnweightingOptions& options = {});

} // namespace montelux
