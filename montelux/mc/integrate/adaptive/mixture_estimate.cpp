#include "montelux/mc/integrate/adaptive/mixture_estimate.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/integrate/adaptive/balanced_points.h"
#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

constexpr double fastest_fall = 1.5;    // exponent by which errors may fall with the number of points,
constexpr double most_inflation = 3;    // and the largest factor by which a faster fall is undone
constexpr double cautious = 0.5;        // deviations of an error's own error that are added to it
constexpr double heavy_weight = 5;      // times the mean, of one sample,
constexpr double heavy_influence = 0.5; // and times the standard error, of what it adds
// A single one of normal replicates hardly ever causes so much of the spread.
constexpr double outstanding = 0.8;
constexpr int enough_replicates = 8;

} // namespace

MixtureEstimate::MixtureEstimate(int replicates, int components) {
    sums_.sums = ReplicateSums(replicates, components);
    sums_.extremes = ExtremeValues(components);
}

void MixtureEstimate::explore(const MixtureSums& added, std::uint64_t end) {
    sums_.merge(added);
    points_ = end;
}

void MixtureEstimate::grow(const MixtureSums& added, std::uint64_t end) {
    if (points_ > 0) {
        const CovarianceMoments moments = sums_.sums.moments(points_, false);
        std::vector<double> errors;
        errors.reserve(static_cast<std::size_t>(moments.components()));
        for (int c = 0; c < moments.components(); ++c) errors.push_back(standard_error(moments, c));
        errors_before_ = std::move(errors);
    }
    points_before_ = points_;
    explore(added, end);
}

double MixtureEstimate::inflation(double standard_error, int component) const {
    if (points_before_ == 0 || points_before_ >= points_ || !(standard_error > 0)) return 1;
    const double growth = static_cast<double>(points_before_) / static_cast<double>(points_);
    const double least = errors_before_[static_cast<std::size_t>(component)] * std::pow(growth, fastest_fall);
    return std::clamp(least / standard_error, 1.0, most_inflation);
}

double MixtureEstimate::standard_error(const CovarianceMoments& moments, int component) const {
    const double error =
        caution() * std::sqrt(moments.variance(component) / static_cast<double>(sums_.sums.replicates()));
    return std::max(error * inflation(error, component), least_error(moments, component));
}

double MixtureEstimate::caution() const {
    return 1 + cautious / std::sqrt(2.0 * std::max(1, sums_.sums.replicates() - 1));
}

double MixtureEstimate::least_error(const CovarianceMoments& moments, int component) const {
    double least = sums_.extremes.least_standard_error(component, all_points());
    if (component == 0) {
        const double beyond =
            beyond_the_largest(sums_.extremes.tail(), all_points(), static_cast<double>(all_points()));
        const double spread = std::sqrt(moments.variance(0) / static_cast<double>(sums_.sums.replicates()));
        if (beyond > 0) least = std::max(least, std::hypot(beyond, caution() * spread));
    }
    // Replicates of an indicator agree exactly if each has the same number of points on either side of a
    // jump; their spread then does not contain the jump's position within a cell of the net.
    if (moments.variance(component) > 0) return least;
    return std::max(least, equal_values_error(moments.mean(component), static_cast<double>(all_points())));
}

double MixtureEstimate::error_ratio(const StepRequest& request) const {
    const CovarianceMoments moments = sums_.sums.moments(points_, false);
    double ratio = 0;
    for (int c = 0; c < moments.components(); ++c) {
        const double value = moments.mean(c), error = standard_error(moments, c);
        const double tolerance =
            request.targeted() ? request.tolerance(static_cast<std::size_t>(c), value) : std::abs(value);
        if (error > 0) ratio = std::max(ratio, error / tolerance);
    }
    return ratio;
}

std::uint64_t MixtureEstimate::next_end(const StepRequest& request, std::uint64_t first,
                                        std::uint64_t balanced, std::uint64_t most) const {
    const std::uint64_t affordable =
        points_ + request.max_evaluations / static_cast<std::uint64_t>(sums_.sums.replicates());
    std::uint64_t goal = points_ == 0 ? first : next_balanced(points_);
    if (points_ > 0) {
        const double wanted = request.targeted()
                                  ? static_cast<double>(points_) * std::min(2.0, error_ratio(request))
                                  : static_cast<double>(std::min(2 * points_, affordable));
        while (static_cast<double>(next_balanced(goal)) <= wanted) goal = next_balanced(goal);
    }
    if (goal > affordable) goal = last_balanced(affordable);
    goal = goal / balanced * balanced;
    return std::min(goal, (points_ + most) / balanced * balanced);
}

double MixtureEstimate::expected_rest(const StepRequest& request, double fall) const {
    const double ratio = std::max(1.0, error_ratio(request));
    return static_cast<double>(evaluations()) * (std::pow(ratio, 1 / fall) - 1);
}

void MixtureEstimate::tally(bool full_covariance, Tally& tally) const {
    const auto m = static_cast<std::size_t>(sums_.sums.components());
    if (points_ == 0) {
        tally.value.assign(m, 0.0);
        tally.standard_error.assign(m, infinity);
        return;
    }
    const CovarianceMoments moments = sums_.sums.moments(points_, full_covariance);
    tally_mean(moments, tally);
    for (std::size_t c = 0; c < m; ++c)
        tally.absolute.push_back(sums_.extremes.mean_magnitude(static_cast<int>(c), all_points()));
    std::vector<double> factor(m);
    for (std::size_t c = 0; c < m; ++c)
        factor[c] = caution() * inflation(caution() * tally.standard_error[c], static_cast<int>(c));
    for (std::size_t c = 0; c < m; ++c) tally.standard_error[c] *= factor[c];
    for (std::size_t i = 0; i < tally.covariance.size(); ++i)
        tally.covariance[i] *= factor[i / m] * factor[i % m];
    std::vector<double> least(m);
    for (std::size_t c = 0; c < m; ++c) least[c] = least_error(moments, static_cast<int>(c));
    raise_standard_errors(least, tally);
}

bool MixtureEstimate::heavy_tailed(double standard_error) const {
    const double n = static_cast<double>(points_) * sums_.sums.replicates();
    double size = 0;
    for (const MixtureSums::Channel& c : sums_.channels) size += std::abs(c.sum) / n;
    const double largest = sums_.extremes.largest();
    return largest > heavy_weight * size && largest > heavy_influence * n * standard_error;
}

void MixtureEstimate::warn_of_tail(double standard_error, std::vector<std::string>& warnings) const {
    const double n = static_cast<double>(all_points());
    const double beyond =
        beyond_the_largest(sums_.extremes.tail(), all_points(), n); // which the error contains
    const double spread = std::sqrt(std::max(0.0, standard_error * standard_error - beyond * beyond));
    warn_of_heavy_tail(sums_.extremes.tail(), all_points(), n, spread, warnings);
}

bool MixtureEstimate::has_surprising_weights() const {
    Tally found;
    tally(false, found);
    warn_of_tail(found.standard_error[0], found.warnings);
    return !found.warnings.empty() || heavy_tailed(found.standard_error[0]);
}

bool MixtureEstimate::one_replicate_stands_out() const {
    const int replicates = sums_.sums.replicates();
    if (replicates < enough_replicates) return false;
    double mean = 0, squares = 0, greatest = 0;
    for (int r = 0; r < replicates; ++r) mean += sums_.sums.sum(r, 0) / replicates;
    for (int r = 0; r < replicates; ++r) {
        const double deviation = sums_.sums.sum(r, 0) - mean;
        squares += deviation * deviation;
        greatest = std::max(greatest, deviation * deviation);
    }
    return greatest > outstanding * squares;
}

bool MixtureEstimate::lost_what_is_in(const MixtureEstimate& other) const {
    for (int c = 0; c < sums_.sums.components(); ++c) {
        bool here = false, there = false;
        for (int r = 0; r < sums_.sums.replicates(); ++r) {
            here = here || sums_.sums.sum(r, c) != 0;
            there = there || other.sums_.sums.sum(r, c) != 0;
        }
        if (there && !here) return true;
    }
    return false;
}

void MixtureEstimate::save(StateWriter& state) const {
    state.put(points_);
    state.put(points_before_);
    state.put(errors_before_);
    sums_.save(state);
}

void MixtureEstimate::load(StateReader& state) {
    points_ = state.get_word();
    points_before_ = state.get_word();
    errors_before_ = state.get_doubles();
    if (points_before_ > 0 && errors_before_.size() != static_cast<std::size_t>(sums_.sums.components()))
        throw Error("the saved state has another number of components");
    sums_.load(state);
}

} // namespace montelux
