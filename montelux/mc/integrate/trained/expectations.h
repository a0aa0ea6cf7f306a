// Integrals and means of observables over a target, from the draws of a trained density, with covariances.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "montelux/mc/integrate/trained/target_draws.h"

namespace montelux {

// The integrals of f and of f h_1, ..., f h_m (m + 1 numbers), of f = first component of the target. For
// logarithms all are relative to exp(log_reference).
struct Expectations {
    static constexpr int most_observables = 1023;

    std::vector<double> integral;
    std::vector<double> integral_covariance; // (m + 1) x (m + 1), row by row
    double log_reference = 0;
    std::uint64_t draws = 0, evaluations = 0;
    NonFiniteCount non_finite; // also points that count in Z, but have an observable that is not finite
    bool cancelled = false;    // nothing is known then
    std::vector<std::string> warnings;

    int observables() const { return static_cast<int>(integral.size()) - 1; }
    // The means of the observables over f / Z, m numbers, and their m x m covariances to first order in the
    // errors (Z is estimated from the same draws).
    std::vector<double> mean() const;
    std::vector<double> mean_covariance() const;
};

// From `draws` independent draws, in constant memory. Throws Error, also for more than `most_observables`.
Expectations expectations(const TrainedDensity& density, const Integrand& f, const Integrand& observables,
                          std::uint64_t draws, const SamplingOptions& options = {});

} // namespace montelux
