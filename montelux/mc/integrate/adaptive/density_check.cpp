#include "montelux/mc/integrate/adaptive/density_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace montelux {
namespace {

constexpr double concentrated = 0.1; // effective share of the exploring points below which a check is needed
constexpr double least_walk = 4096;  // evaluations of a check,
constexpr double walk_share = 1 / 16.; // or this share of the weighted evaluations, if they are more;
// where ridges may bend (uneven weights in several variables) a larger share of all, up to so many
constexpr double bent_share = 0.25, long_walk = 16384;
constexpr int few_dimensions = 3;
constexpr double even_weights = 0.1;        // relative variance
constexpr std::uint64_t checked_growth = 4; // of points for which a check holds
constexpr double fitted_share = 0.5;        // unseen share over target above which a density is fitted again,
constexpr double warned_share = 1;          // and above which a result has a warning where it cannot be
constexpr double least_unseen = 2e-4;       // smaller shares are noise of the walk

// The target relative to the first component.
double relative_target(const MixtureEstimate& estimate, const StepRequest& request) {
    Tally tally;
    estimate.tally(false, tally);
    const double size = request.size(0, tally.value[0]);
    return std::max(request.relative_error, size > 0 ? request.absolute_error / size : 0);
}

} // namespace

bool DensityCheck::covers(const DensityTrainer& trainer, std::uint64_t points) const {
    return points <= checked_points_ || trainer.effective_share() >= concentrated ||
           trainer.density().dimensions() > DensityTrainer::max_gaussian_dimensions;
}

bool DensityCheck::due(const DensityTrainer& trainer, const MixtureEstimate& estimate,
                       const StepRequest& request, std::uint64_t early) const {
    if (!request.targeted() || covers(trainer, estimate.points())) return false;
    return estimate.points() >= early || (estimate.compared() && estimate.error_ratio(request) <= 1);
}

bool DensityCheck::run(DensityTrainer& trainer, const MixtureEstimate& estimate, const StepRequest& request,
                       bool again) {
    const double left = static_cast<double>(request.max_evaluations);
    const double weighted = static_cast<double>(estimate.evaluations());
    double walk = std::max(least_walk, walk_share * weighted);
    if (trainer.density().dimensions() > few_dimensions && trainer.relative_variance() > even_weights) {
        const double all = weighted + static_cast<double>(trainer.evaluations());
        walk = std::max(walk, std::min(long_walk, bent_share * all));
    }
    walk = std::min(walk, left);
    const double expected =
        static_cast<double>(estimate.all_points()) + std::min(left, estimate.expected_rest(request));
    const double target = relative_target(estimate, request);
    const std::optional<double> unseen = trainer.unseen_share(expected, static_cast<std::uint64_t>(walk));
    if (!unseen) return false;
    const double accepted = std::max(least_unseen, (again ? fitted_share : warned_share) * target);
    unseen_ = *unseen > accepted ? *unseen : 0;
    checked_points_ = checked_growth * estimate.points();
    return true;
}

void DensityCheck::warn(Tally& tally) const {
    if (!(unseen_ > 0)) return;
    char text[128];
    std::snprintf(text, sizeof text,
                  "about %.3g %% of the integral lies where the trained density hardly samples",
                  100 * unseen_);
    tally.warnings.emplace_back(text);
}

void DensityCheck::save(StateWriter& state) const {
    state.put(checked_points_);
    state.put(unseen_);
}

void DensityCheck::load(StateReader& state) {
    checked_points_ = state.get_word();
    unseen_ = state.get_double();
}

} // namespace montelux
