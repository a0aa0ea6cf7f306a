// Interface of all estimators: steps that add evaluations, a tally at any time, a state that can be saved.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/mc/integrate/evaluator.h"
#include "montelux/mc/integrate/state_archive.h"
#include "montelux/mc/parallel/cancel_flag.h"

namespace montelux {

class UnitDensity;
struct FirstLook;

// Does a method begin with a first look at the integrand? Methods that draw the same points whatever they see do so
// only for a target, which they might claim wrongly.
enum class FirstLookUse : std::uint8_t { never, with_target, always };

// The problem that an estimator solves.
struct Problem {
    const Evaluator& evaluator; // outlives the estimator
    std::uint64_t seed = 0;
    bool full_covariance = true; // else variances of the components alone
    // What was seen before the first step; null: nothing. Outlives the estimator.
    const FirstLook* look = nullptr;
};

struct StepRequest {
    // The step must not evaluate the integrand more often than this.
    std::uint64_t max_evaluations = 0;
    // Targets of the step; 0 where there is none.
    double relative_error = 0, absolute_error = 0;
    const CancelFlag* cancel = nullptr;
    // The integrand throws IntegrandInterrupted from here on; what works long without it asks.
    std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::time_point::max();
    // Sizes that the relative error refers to where they exceed the values: one per component, or none.
    std::span<const double> sizes = {};

    bool over() const {
        return (cancel && cancel->requested()) || (deadline != std::chrono::steady_clock::time_point::max() &&
                                                   std::chrono::steady_clock::now() >= deadline);
    }
    bool targeted() const { return relative_error > 0 || absolute_error > 0; }
    // Size of a component of this value that the relative error refers to.
    double size(std::size_t component, double value) const {
        return std::max(std::abs(value), component < sizes.size() ? sizes[component] : 0.0);
    }
    // Standard error that a component of this value may have.
    double tolerance(std::size_t component, double value) const {
        return std::max(absolute_error, relative_error * size(component, value));
    }
};

enum class StepOutcome : std::uint8_t {
    advanced,
    exhausted, // the smallest step does not fit into `max_evaluations`; the state did not change
    finished,  // no further evaluations would change the estimate; the state did not change
    cancelled, // the state did not change
};

// Values, errors and warnings of an estimate at this moment.
struct Tally {
    std::vector<double> value, standard_error; // infinite errors while nothing is known
    std::vector<double> covariance;            // components x components, or empty
    // Integrals of the absolute values, roughly, one per component; empty where the method does not know them.
    std::vector<double> absolute;
    bool statistical = true;
    std::uint64_t evaluations = 0;       // pilots included
    std::uint64_t check_evaluations = 0; // of these: independent points that check a rule
    NonFiniteCount non_finite;
    // Points replaced by others nearby, since the integrand was not finite there.
    std::uint64_t singular = 0;
    double chi_squared = 0;
    int degrees_of_freedom = 0;
    // Of chi-squared, where its law is not that of so many degrees of freedom; else not a number.
    double p_value = std::numeric_limits<double>::quiet_NaN();
    // The target must not be believed before this is true (a pilot is running, too few replicates).
    bool ready = true;
    // The remaining error is rounding, or that of points that all agree: more evaluations do not help.
    bool at_limit = false;
    // The integral is concentrated in too small a part of the domain for random points to check the rule.
    bool localised = false;
    // Hardly any random point saw anything but zero, and chance found the peaks: there may be others.
    bool sparse = false;
    std::vector<std::string> warnings;
    std::vector<std::string> notes; // what is no warning, but good to know
    std::string method, reason;     // filled by estimators that choose among others
};

// An estimate that grows step by step. A step depends only on the problem, the settings, the state and the
// request, never on time or threads; so a resumed run ends with the same bits as an uninterrupted one.
// Cancelling, and an exception of the integrand (including IntegrandInterrupted), leave the state as it was
// before the step. A step takes at most about a million evaluations, or a tenth of those made so far.
class Estimator {
  public:
    virtual ~Estimator() = default;

    virtual StepOutcome step(const StepRequest& request) = 0;
    virtual Tally tally() const = 0;
    // The state between two steps. `load` gets what `save` of an estimator with equal settings wrote.
    virtual void save(StateWriter& state) const = 0;
    virtual void load(StateReader& state) = 0;
    // The density on the unit cube that the estimator has trained so far; null where it trains none.
    virtual std::shared_ptr<const UnitDensity> density() const { return nullptr; }
    // The density that drew the points of the tally; null: uniform.
    virtual std::shared_ptr<const UnitDensity> sampled_density() const { return density(); }
};

} // namespace montelux
