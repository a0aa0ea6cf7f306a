// Verification of a cubature's regions by random points, with the surprises found.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "montelux/mc/integrate/cubature/cubature_check.h"
#include "montelux/mc/integrate/estimator.h"

namespace montelux {

// A result that claims its target is checked by random points. A point with an unexpected value becomes a
// witness: its region's error is at least volume x surprise, and it is halved until a rule predicts the value
// or the volume is negligible. If the value then moves by more than the checked error, it is checked again
// with new points.
class CubatureVerification {
  public:
    // `points` of each check; 0: none is made.
    CubatureVerification(const Problem& problem, std::uint64_t points);

    // Were these values checked, and is nothing open?
    bool verified(std::span<const double> value) const;
    // Should the next step be a check? `claimed`: the errors reach the request's target, or no region is left
    // to halve.
    bool due(const CubatureRegions& regions, std::span<const double> value, std::span<const double> error,
             std::uint64_t evaluations, const StepRequest& request, bool claimed) const;
    // Points of a check that is due; 0 where the evaluations left are too few for one.
    std::uint64_t points(const CubatureRegions& regions, std::span<const double> value,
                         std::uint64_t evaluations, const StepRequest& request) const;
    // Notes whether the integrand is flat but for separate features. Before a check.
    void note_features(const CubatureRegions& regions);
    // Makes a check, and adds the witnesses' errors to their regions. Returns the evaluations made; empty,
    // and nothing changed, when cancelled.
    std::uint64_t run(CubatureRegions& regions, std::span<const double> value, std::span<const double> error,
                      std::uint64_t points, const StepRequest& request);
    // Compares the regions with all that was seen before (by the first look, by earlier checks): what is a surprise to
    // a region that contains or touches it becomes a witness. Costs no evaluations. True if there are any.
    bool recall(CubatureRegions& regions, std::span<const double> value, std::span<const double> error,
                const StepRequest& request);
    // Was this number of regions compared so?
    bool recalled(std::size_t regions) const;
    // Are there twice as many regions as at the last recall? Without a target no claim calls for it.
    bool outgrown(std::size_t regions) const { return regions >= 2 * recalled_regions_; }
    // Tolerances of open witnesses, which follow the value.
    void update(const CubatureRegions& regions, std::span<const double> value, std::span<const double> error,
                const StepRequest& request);
    // After the regions were evaluated by other rules: compares open witnesses with them.
    void revisit(CubatureRegions& regions);
    // Notes errors that are claimed: halving a part of the regions to confirm them does not show much smaller ones.
    void claim(std::span<const double> error);
    // Forgets that the values were checked.
    void renew() { checked_value_.clear(); }
    // Notes that a check could not be made.
    void skip(std::span<const double> value, std::span<const double> error);
    // After halving: lower halves in the place of `parents`, upper halves from `first_new` on. Adds the
    // witnesses' errors.
    void follow(CubatureRegions& regions, std::span<const std::size_t> parents, std::size_t first_new);

    std::uint64_t evaluations() const { return evaluations_; }
    const NonFiniteCount& non_finite() const { return non_finite_; }
    // Widens the range of a component's values by what the points met.
    void widen(std::size_t component, double& lowest, double& highest) const;
    // Correlation of the rules' errors of two components, as the residuals at the points show it; 0 before
    // the first check.
    double correlation(std::size_t a, std::size_t b) const;
    bool knows_correlations() const { return residual_.full() && residual_.count() > 1; }
    // Number of points of the last check.
    std::uint64_t points() const { return checked_points_; }
    // Did so few points fall into the part that holds half of the integral, by the rules, that other such
    // parts may have been missed?
    bool blind() const { return points_in_bulk_ < enough_in_bulk; }
    // Features of one variable that are separated by a flat background.
    std::size_t features() const { return features_; }
    // Additional error of a component if points have shown that the rules may be wrong.
    double slack(std::size_t component) const {
        return std::max({slack_.empty() ? 0.0 : slack_[component], shown_[component],
                         enough_points_ ? overlooked(component) : 0.0});
    }
    // Whether there are several separate features, or surprises, so that there may be more of them, which further points
    // find.
    bool is_scattered() const {
        return std::ranges::any_of(scattered_, [](double size) { return size > 0; });
    }
    // Whether so many points are many more than those of the last check.
    bool may_grow(std::uint64_t points) const { return points >= 2 * checked_points_; }
    // Factor by which a component's errors must grow: the value moved by more than they between two checks that found
    // nothing.
    double drift(std::size_t component) const { return drift_[component]; }
    // Normally empty.
    const std::string& warning() const { return warning_; }

    void save(StateWriter& state) const;
    void load(StateReader& state, std::size_t regions);

  private:
    static constexpr double enough_in_bulk = 24;
    std::vector<double> tolerances(const CubatureRegions& regions, std::span<const double> value,
                                   std::span<const double> error, const StepRequest& request) const;
    // Error that the witness adds to its region; 0 where it is expected or negligible.
    double weight(const CubatureRegions& regions, const CubatureWitness& witness,
                  std::size_t component) const;
    // Errors of regions whose points disagree with their rule, if the whole disagrees.
    void add_differences(CubatureRegions& regions, const CubatureCheck& check, std::size_t component);
    void add_errors(CubatureRegions& regions, std::span<const std::size_t> of_regions);
    // Several surprises are parts of one long feature, or of many: there may be more of them.
    void note_scattered_surprises(const CubatureRegions& regions);
    void note_drift(std::span<const double> value);
    // What one more feature that the last check met nowhere would hold.
    double overlooked(std::size_t component) const {
        return checked_points_ > 0 ? scattered_[component] / static_cast<double>(checked_points_) : 0;
    }

    Problem problem_;
    std::uint64_t points_;
    std::vector<CubatureWitness> witnesses_; // open ones
    std::vector<CubatureWitness> seen_;      // surprises of all checks
    std::size_t recalled_regions_ = 0, recalled_peaks_ = 0, checked_regions_ = 0;
    std::vector<double> checked_value_, checked_error_, tolerance_; // empty before the first check
    CovarianceMoments residual_;
    std::vector<double> lowest_, highest_;
    std::uint64_t rounds_ = 0, evaluations_ = 0;
    std::uint64_t next_ = 0; // evaluations at which a run without a target is checked
    NonFiniteCount non_finite_;
    double points_in_bulk_ = 0;
    bool surprised_ = false; // by any check
    // Least errors: after surprises; by what was seen before, once it showed rules to be wrong, or a share of what was
    // claimed and confirmed.
    std::vector<double> slack_, shown_;
    std::vector<double> drift_;
    std::size_t features_ = 0;
    // Mean height of several separate features, or of several surprises; else 0.
    std::vector<double> scattered_;
    std::vector<std::uint64_t> surprising_; // their number over all checks
    std::uint64_t checked_points_ = 0;
    bool enough_points_ = true; // for features of that size
    bool unsurprised_ = false;  // since before the last check
    bool disagrees_ = false;    // the mean of the points, in the last check,
    bool doubtful_ = false;     // or it may: more points decide
    bool misses_ = false; // surprises of the last check held too much for a claim, and may not have been all
    std::string warning_;
};

} // namespace montelux
