// An estimate that grows: the mean of a mixture's replicates, and the error that it is believed to have.
#pragma once

#include <cstdint>
#include <vector>

#include "montelux/mc/integrate/adaptive/mixture_sampling.h"

namespace montelux {

// Every replicate has the same number of points. The error of the mean comes from the spread of the
// replicates (Student's law with replicates - 1 degrees of freedom), but is no lower than the error before
// the last step allows: one that seems to fall faster than points of bounded variation make it fall was luck,
// and stopping there would select luck.
class MixtureEstimate {
  public:
    MixtureEstimate(int replicates, int components);

    const MixtureSums& sums() const { return sums_; }
    std::uint64_t points() const { return points_; } // of each replicate
    std::uint64_t all_points() const { return points_ * static_cast<std::uint64_t>(sums_.sums.replicates()); }
    std::uint64_t evaluations() const { return sums_.evaluations; }

    // Points [points(), end) of each replicate, found by exploring: the next error is compared with none.
    void explore(const MixtureSums& added, std::uint64_t end);
    // The same as a step of the estimate, whose error is remembered for the next.
    void grow(const MixtureSums& added, std::uint64_t end);
    // Has the error been compared with one before?
    bool compared() const { return points_before_ > 0; }
    void compare_anew() { points_before_ = 0; }

    // The largest quotient of error and tolerance over the components; the relative error itself where there
    // is no target. Above 1: not there yet.
    double error_ratio(const StepRequest& request) const;
    // Evaluations that are still expected to be needed.
    double expected_rest(const StepRequest& request) const;
    // Fills values, errors and covariance; zero with infinite errors while there are no points.
    void tally(bool full_covariance, Tally& tally) const;

    // Does one sample of the first component make up a good part of an error? Then others like it were
    // probably not drawn yet.
    bool heavy_tailed(double standard_error) const;
    // Does one replicate make up nearly all of the spread?
    bool one_replicate_stands_out() const;
    // Is a component zero, without an error, of which `other` saw something?
    bool lost_what_is_in(const MixtureEstimate& other) const;

    // `load` keeps the number of replicates and components. Throws Error where the saved ones differ.
    void save(StateWriter& state) const;
    void load(StateReader& state);

  private:
    double standard_error(const CovarianceMoments& moments, int component) const;
    // What the number of points justifies, whatever the spread of the replicates.
    double least_error(const CovarianceMoments& moments, int component) const;
    double inflation(double standard_error, int component) const;

    MixtureSums sums_;
    std::uint64_t points_ = 0, points_before_ = 0;
    std::vector<double> errors_before_; // of the components, at points_before_
};

} // namespace montelux
