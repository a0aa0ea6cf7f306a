// The mean of a mixture's replicates, and its error, as points are added.
#pragma once

#include <cstdint>
#include <vector>

#include "montelux/mc/integrate/adaptive/mixture_sampling.h"

namespace montelux {

// Every replicate has the same number of points. The error of the mean comes from the spread of the
// replicates (Student's law with replicates - 1 degrees of freedom), but is bounded below by the error before
// the last step: an error that falls faster than for integrands of bounded variation is luck, and stopping
// there would select luck.
class MixtureEstimate {
  public:
    MixtureEstimate(int replicates, int components);

    const MixtureSums& sums() const { return sums_; }
    std::uint64_t points() const { return points_; } // of each replicate
    std::uint64_t all_points() const { return points_ * static_cast<std::uint64_t>(sums_.sums.replicates()); }
    std::uint64_t evaluations() const { return sums_.evaluations; }

    // Adds points [points(), end) of each replicate from the exploration: the next error has no lower bound.
    void explore(const MixtureSums& added, std::uint64_t end);
    // The same as a step of the estimate, whose error bounds the next.
    void grow(const MixtureSums& added, std::uint64_t end);
    // Has the error been bounded by an earlier one?
    bool compared() const { return points_before_ > 0; }
    void compare_anew() { points_before_ = 0; }

    // The largest quotient of error and tolerance over the components; the relative error itself where there
    // is no target. Above 1: not reached.
    double error_ratio(const StepRequest& request) const;
    // Where the next step ends, in points of each replicate: `first`, then twice as far at most and no further than the
    // target is expected to need; within the allowed evaluations, `most` points, and in multiples of `balanced`. Not
    // above points(): nothing more can be done.
    std::uint64_t next_end(const StepRequest& request, std::uint64_t first, std::uint64_t balanced,
                           std::uint64_t most) const;
    // Expected further evaluations if errors fall with this power of the number of points; the usual one of integrands
    // without jumps.
    double expected_rest(const StepRequest& request, double fall = 1.2) const;
    // Fills values, errors and covariance; zero with infinite errors while there are no points.
    void tally(bool full_covariance, Tally& tally) const;

    // Does one sample of the first component dominate an error? Then others like it were probably not drawn
    // yet.
    bool heavy_tailed(double standard_error) const;
    // Adds a warning if the variance of the weights is probably infinite.
    void warn_of_tail(double standard_error, std::vector<std::string>& warnings) const;
    // Are there such weights, or one that dominates an error?
    bool has_surprising_weights() const;
    // Does one replicate cause nearly all of the spread?
    bool one_replicate_stands_out() const;
    // Is a component zero with no error, although `other` saw it non-zero?
    bool lost_what_is_in(const MixtureEstimate& other) const;

    // `load` keeps the number of replicates and components. Throws Error where the saved ones differ.
    void save(StateWriter& state) const;
    void load(StateReader& state);

  private:
    double standard_error(const CovarianceMoments& moments, int component) const;
    // Lower bound by the number of points, whatever the spread of the replicates.
    double least_error(const CovarianceMoments& moments, int component) const;
    double inflation(double standard_error, int component) const;
    // Factor that raises errors: a run stops as soon as they are small enough, and so prefers those that chance made too
    // small. Half a standard deviation of an error that is estimated from so many replicates.
    double caution() const;

    MixtureSums sums_;
    std::uint64_t points_ = 0, points_before_ = 0;
    std::vector<double> errors_before_; // of the components, at points_before_
};

} // namespace montelux
