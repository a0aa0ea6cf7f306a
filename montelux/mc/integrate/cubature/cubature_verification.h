// Whether the regions of a cubature have been verified by random points, and what these found.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "montelux/mc/integrate/cubature/cubature_check.h"
#include "montelux/mc/integrate/estimator.h"

namespace montelux {

// No rule is believed on its own word. A result that claims its target is checked by random points; a point
// whose value is a surprise becomes a witness: its region counts as wrong by volume x surprise, and is halved
// until a rule expects the value or the volume is negligible. What moved the value by more than the error
// that was checked is checked again with new points.
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
    // Makes a check, and adds what witnesses tell to the errors of their regions. The evaluations made; none
    // when cancelled, and then nothing changed.
    std::uint64_t run(CubatureRegions& regions, std::span<const double> value, std::span<const double> error,
                      std::uint64_t points, const StepRequest& request);
    // Forgets that the values were checked.
    void renew() { checked_value_.clear(); }
    // Takes note of a check that could not be made.
    void skip(std::span<const double> value, std::span<const double> error);
    // After halving: lower halves in the place of `parents`, upper halves from `first_new` on. Adds what
    // witnesses tell to their errors.
    void follow(CubatureRegions& regions, std::span<const std::size_t> parents, std::size_t first_new);

    std::uint64_t evaluations() const { return evaluations_; }
    const NonFiniteCount& non_finite() const { return non_finite_; }
    // Widens the range of a component's values by what the points met.
    void widen(std::size_t component, double& lowest, double& highest) const;
    // Correlation of the rules' errors of two components, as the residuals at the points show it; 0 before
    // the first check.
    double correlation(std::size_t a, std::size_t b) const;
    bool knows_correlations() const { return residual_.full() && residual_.count() > 1; }
    // Did so few points fall where half of the integral is, as the rules see it, that other such places may
    // have been missed?
    bool blind() const { return points_in_bulk_ < enough_in_bulk; }
    // Error of a component beyond that of the rules, where points have shown that these may be wrong.
    double slack(std::size_t component) const { return slack_.empty() ? 0 : slack_[component]; }
    // Empty in the normal case.
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
    // Of regions whose points disagree with their rule, where the whole does.
    void add_differences(CubatureRegions& regions, const CubatureCheck& check, std::size_t component);
    void add_errors(CubatureRegions& regions, std::span<const std::size_t> of_regions);

    Problem problem_;
    std::uint64_t points_;
    std::vector<CubatureWitness> witnesses_;
    std::vector<double> checked_value_, checked_error_, tolerance_; // empty before the first check
    CovarianceMoments residual_;
    std::vector<double> lowest_, highest_;
    std::uint64_t rounds_ = 0, evaluations_ = 0;
    std::uint64_t next_ = 0; // evaluations at which a run without a target is checked
    NonFiniteCount non_finite_;
    double points_in_bulk_ = 0;
    bool surprised_ = false; // by any check
    std::vector<double> slack_;
    bool disagrees_ = false; // the mean of the points, in the last check
    std::string warning_;
};

} // namespace montelux
