// Result of an integration: values, errors, cost, warnings and the course of the run.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/mc/stats/estimate.h"

namespace montelux {

class TrainedDensity;

enum class StopReason : std::uint8_t {
    error_target, // each component reached its absolute or relative error
    evaluations,  // the next step would exceed the number of evaluations allowed
    time,
    interrupted, // by IntegrationOptions::cancel
    diverges,    // the integral does not exist, or converges too slowly to tell
    finished,    // the method has nothing further to do (a fixed grid)
};
// "error_target", ...
std::string_view to_string(StopReason reason);

// The state after one step.
struct IterationRecord {
    std::uint64_t evaluations = 0; // so far
    double value = 0;              // of the first component
    double standard_error = 0;
    double seconds = 0; // wall time so far; the only field that differs between equal runs
};

struct IntegrationResult {
    // One per component.
    std::vector<double> value;
    // Standard deviation of each value; for deterministic rules their error estimate (see `statistical`).
    std::vector<double> standard_error;
    // Of the values, row by row, components x components; empty where the method or the options leave it out.
    std::vector<double> covariance;
    // True where the errors are standard deviations of a random estimate; false for deterministic rules,
    // whose errors are differences of rules, and for grids, whose errors are unknown (infinite).
    bool statistical = true;
    std::uint64_t evaluations = 0; // of the integrand, pilots included
    std::uint64_t non_finite = 0;
    std::vector<double> first_non_finite_point;
    std::vector<IterationRecord> history;
    // Do independent parts of the run (iterations, replicates) agree? Zero degrees of freedom where there is
    // nothing to compare; the p-value is then 1. It takes into account that comparisons of iterations with the
    // mean before them are correlated, as the law of chi-squared does not.
    double chi_squared = 0;
    int degrees_of_freedom = 0;
    double p_value = 1;
    std::string method; // the requested name, or the one that Auto chose
    std::string reason; // of Auto's choice; else empty
    StopReason stop = StopReason::finished;
    // Reasons why the value or its error may be wrong, as sentences. Normally empty.
    std::vector<std::string> warnings;
    // How the result was judged where that is not obvious, as sentences.
    std::vector<std::string> notes;
    // Why the newest checkpoint could not be resumed and the previous one was; else empty.
    std::string checkpoint_refused_because;
    double seconds = 0; // wall time
    // What the method learned about the integrand: a density to draw samples from, to save and to use again.
    // Null where it trains none (all but adaptive, vegas and vegas_sobol), and in reports of progress.
    std::shared_ptr<const TrainedDensity> density = nullptr;

    // The targets were met without a warning.
    bool converged() const { return stop == StopReason::error_target && warnings.empty(); }
    // One component as a value with its error.
    Estimate estimate(int component = 0) const;
    double chi_squared_per_degree() const {
        return degrees_of_freedom > 0 ? chi_squared / degrees_of_freedom : 0;
    }
};

// One line per component, as 1.2345(67); then evaluations, method, the reason to stop, notes and warnings.
std::string to_string(const IntegrationResult& result);
std::ostream& operator<<(std::ostream& out, const IntegrationResult& result);

} // namespace montelux
