#include "montelux/mc/integrate/cubature/cubature_verification.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "montelux/mc/integrate/cubature/cubature_climb.h"
#include "montelux/mc/integrate/cubature/cubature_seams.h"
#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/integrate/sampling.h"
#include "montelux/mc/integrate/witness/first_look.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

constexpr double negligible_surprise = 0.02; // share of the tolerance
constexpr double least_tolerance = 1e-7;     // share of the integral of the absolute value
constexpr double most_missed = 0.5;          // share of the tolerance that surprises may hold
constexpr double suspicion = 2.5;            // standard errors beyond which the difference counts as an error
constexpr double significant_errors = 5;     // standard errors between rules and points
constexpr std::uint64_t most_rounds = 12;
constexpr std::uint64_t fewest_points = 16;
constexpr std::size_t fewest_features = 3; // or surprises, that call for more points
// Features that are separated by a background of one value, to within a part of the range, in so much of the domain.
constexpr double flatness = 1e-3, least_background = 0.4;
constexpr std::uint64_t most_points = 1 << 20; // for them, and after doubts
constexpr std::uint64_t points_of_doubt = 4;   // times those of the check before
constexpr double plateau = 0.1;                // range of the values beside their mean
constexpr std::uint64_t plateau_points = 4;    // times as many points if only a plateau was seen
// Points for an integrand with jumps, times the relative target: a part that holds four targets of the volume is then
// overlooked with a probability of e^-4.8; at most this many times as many.
constexpr double points_per_target = 2;
constexpr std::uint64_t most_of_jumps = 5;
// The regions that are not smooth: with less volume they are about a singular point, and in a few large regions smooth
// integrands look no different from jumps.
constexpr double least_of_jumps = 0.01;
constexpr std::size_t fewest_of_jumps = 32;
constexpr double most_points_of_line = 4096;
constexpr std::size_t most_seen = 256;   // surprises that are kept for later
constexpr double shown_by_checks = 0.01; // error that they can show, as a share of the tolerance
constexpr double share_of_claim = 0.25;  // of an error that was claimed and confirmed, which stays
constexpr double caution_of_drift = 2;   // errors that halve from check to check move the value by half
constexpr double peak_widening = 2;      // volume of a peak over that of its half height

// The least volume that holds half of the integral of |g|, of the component that is most concentrated.
double volume_of_half(const CubatureRegions& regions) {
    double least = 1;
    std::vector<std::size_t> order(regions.count());
    for (std::size_t c = 0; c < regions.value(0).size(); ++c) {
        std::iota(order.begin(), order.end(), std::size_t{0});
        auto density = [&](std::size_t r) { return std::abs(regions.value(r)[c]) / regions.volume(r); };
        std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return density(a) > density(b); });
        double all = 0, found = 0, volume = 0;
        for (std::size_t r : order) all += std::abs(regions.value(r)[c]);
        for (std::size_t r : order) {
            if (found >= 0.5 * all) break;
            found += std::abs(regions.value(r)[c]);
            volume += regions.volume(r);
        }
        if (all > 0) least = std::min(least, volume);
    }
    return least;
}

void save_witness(StateWriter& state, const CubatureWitness& w) {
    state.put(static_cast<std::uint64_t>(w.region));
    state.put(w.x);
    state.put(w.value);
    state.put(w.volume);
}

} // namespace

CubatureVerification::CubatureVerification(const Problem& problem, std::uint64_t points)
    : problem_(problem), points_(points), residual_(problem.evaluator.components(), problem.full_covariance),
      lowest_(static_cast<std::size_t>(problem.evaluator.components()), infinity),
      highest_(lowest_.size(), -infinity), next_(4 * points), shown_(lowest_.size(), 0.0),
      drift_(lowest_.size(), 1.0), scattered_(lowest_.size(), 0.0), surprising_(lowest_.size(), 0) {}

bool CubatureVerification::verified(std::span<const double> value) const {
    if (points_ == 0) return true;
    if (checked_value_.empty() || !witnesses_.empty()) return false;
    if (!warning_.empty()) return true; // no further check would help
    if (disagrees_ || doubtful_ || misses_ || !enough_points_) return false;
    for (std::size_t c = 0; c < value.size(); ++c)
        if (!(std::abs(value[c] - checked_value_[c]) <= checked_error_[c])) return false;
    return true;
}

bool CubatureVerification::due(const CubatureRegions& regions, std::span<const double> value,
                               std::span<const double> error, std::uint64_t evaluations,
                               const StepRequest& request, bool claimed) const {
    if (points_ == 0 || !warning_.empty() || !witnesses_.empty()) return false;
    // An error that an earlier check left, when regions were larger, may be most of what is claimed, or all that is above
    // a target.
    for (std::size_t c = 0; c < error.size(); ++c)
        if (2 * regions.count() >= 3 * checked_regions_ && slack(c) > 0.5 * error[c] &&
            (!request.targeted() || error[c] > request.tolerance(c, value[c])))
            return true;
    bool fresh = !verified(value);
    if (!fresh) { // a tighter target sees smaller surprises
        const std::vector<double> now = tolerances(regions, value, error, request);
        for (std::size_t c = 0; c < now.size(); ++c) fresh = fresh || now[c] < 0.5 * tolerance_[c];
    }
    if (!fresh) return false;
    if (claimed) return true;
    if (request.targeted()) return false;
    const std::uint64_t all = evaluations + request.max_evaluations;
    return evaluations >= next_ || request.max_evaluations <= std::min(points_, all / 8) * 5 / 4;
}

std::uint64_t CubatureVerification::points(const CubatureRegions& regions, std::span<const double> value,
                                           std::uint64_t evaluations, const StepRequest& request) const {
    bool flat = true;
    for (std::size_t c = 0; c < value.size(); ++c) {
        double low = infinity, high = -infinity;
        for (std::size_t r = 0; r < regions.count(); ++r) {
            low = std::min(low, regions.lowest(r)[c]);
            high = std::max(high, regions.highest(r)[c]);
        }
        flat = flat && high - low <= plateau * std::abs(value[c]);
    }
    std::uint64_t wanted = flat ? plateau_points * points_ : points_;
    // More points cost little in one variable: enough to meet parts as wide as those that hold half of the integral.
    if (problem_.evaluator.dimensions() == 1)
        wanted = std::max(wanted, static_cast<std::uint64_t>(std::min(
                                      enough_in_bulk / volume_of_half(regions), most_points_of_line)));
    // Where there is one jump there may be another, close to the faces of regions, where rules have no points.
    double volume = 0;
    std::size_t rough = 0;
    for (std::size_t r = 0; r < regions.count(); ++r)
        if (regions.marks(r).rough) {
            volume += regions.volume(r);
            ++rough;
        }
    if (volume > least_of_jumps && rough >= fewest_of_jumps && problem_.evaluator.dimensions() > 1)
        for (std::size_t c = 0; c < value.size(); ++c) {
            const double size = request.size(c, value[c]);
            const double target = size > 0 ? request.tolerance(c, value[c]) / size : 0;
            if (target > 0)
                wanted = std::max(
                    wanted, static_cast<std::uint64_t>(std::min(
                                points_per_target / target, static_cast<double>(most_of_jumps * points_))));
        }
    if (surprised_) wanted = std::max(wanted, checked_points_);
    if (doubtful_) wanted = std::max(wanted, std::min(points_of_doubt * checked_points_, most_points));
    if (is_scattered()) {
        double needed = request.targeted() ? 0 : static_cast<double>(evaluations);
        for (std::size_t c = 0; request.targeted() && c < value.size(); ++c)
            needed = std::max(needed, 2 * scattered_[c] / request.tolerance(c, value[c]));
        wanted = std::max(wanted, static_cast<std::uint64_t>(
                                      std::ceil(std::min(needed, static_cast<double>(most_points)))));
    }
    const std::uint64_t all = evaluations + request.max_evaluations;
    const std::uint64_t points =
        std::min({wanted, all / (request.targeted() ? 2 : 8), request.max_evaluations});
    return points < fewest_points ? 0 : points;
}

std::vector<double> CubatureVerification::tolerances(const CubatureRegions& regions,
                                                     std::span<const double> value,
                                                     std::span<const double> error,
                                                     const StepRequest& request) const {
    std::vector<double> tolerance(value.size());
    for (std::size_t c = 0; c < value.size(); ++c) {
        double size = 0;
        for (std::size_t r = 0; r < regions.count(); ++r)
            size +=
                regions.volume(r) * std::max(std::abs(regions.lowest(r)[c]), std::abs(regions.highest(r)[c]));
        // A relative target of a vanishing value cannot be met.
        tolerance[c] = std::max(error[c], least_tolerance * size);
        if (request.targeted()) tolerance[c] = std::max(tolerance[c], request.tolerance(c, value[c]));
    }
    return tolerance;
}

void CubatureVerification::note_features(const CubatureRegions& regions) {
    if (problem_.evaluator.dimensions() != 1) return;
    std::vector<std::size_t> order(regions.count());
    const auto mean = [&](std::size_t r, std::size_t c) { return regions.value(r)[c] / regions.volume(r); };
    for (std::size_t c = 0; c < lowest_.size(); ++c) {
        // The background: the median of the means, by volume.
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::sort(order, {}, [&](std::size_t r) { return mean(r, c); });
        double volume = 0, low = infinity, high = -infinity, background = 0;
        for (std::size_t r : order) {
            if (volume < 0.5) background = mean(r, c);
            volume += regions.volume(r);
            low = std::min(low, regions.lowest(r)[c]);
            high = std::max(high, regions.highest(r)[c]);
        }
        std::ranges::sort(order, {}, [&](std::size_t r) { return regions.centre(r)[0]; });
        double height = 0, flat = 0;
        std::size_t features = 0;
        bool inside = false;
        for (std::size_t r : order) {
            const double above = std::abs(mean(r, c) - background);
            const bool feature = above > flatness * (high - low);
            if (!feature) flat += regions.volume(r);
            if (feature && !inside) ++features;
            if (feature) height += above * regions.volume(r);
            inside = feature;
        }
        if (flat < least_background) continue;
        features_ = std::max(features_, features);
        if (features >= fewest_features) scattered_[c] = height / std::max(1 - flat, 1e-300);
    }
}

std::uint64_t CubatureVerification::run(CubatureRegions& regions, std::span<const double> value,
                                        std::span<const double> error, std::uint64_t points,
                                        const StepRequest& request) {
    std::vector<double> tolerance = tolerances(regions, value, error, request);
    auto check = check_regions(problem_.evaluator, regions, points, problem_.seed, rounds_, tolerance,
                               problem_.full_covariance, request.cancel);
    if (!check) return 0;
    points_in_bulk_ = static_cast<double>(points) * volume_of_half(regions);
    CubatureClimb climb(problem_.evaluator, regions, tolerance, (request.max_evaluations - points) / 4,
                        *check);
    climb.from_surprises();
    if (blind()) climb.from_hints();
    const std::uint64_t climbed = climb.evaluations();
    ++rounds_;
    evaluations_ += points + climbed;
    non_finite_.merge(check->non_finite);
    next_ = 8 * std::max(next_, points);
    tolerance_ = std::move(tolerance);
    residual_ = std::move(check->residual);
    note_drift(value);
    checked_regions_ = regions.count();
    checked_value_.assign(value.begin(), value.end());
    checked_error_.assign(error.begin(), error.end());
    slack_.resize(lowest_.size(), 0.0);
    doubtful_ = misses_ = false;
    for (std::size_t c = 0; c < lowest_.size(); ++c) {
        lowest_[c] = std::min(lowest_[c], check->lowest[c]);
        highest_[c] = std::max(highest_[c], check->highest[c]);
        const double difference = std::abs(check->difference[c]), noise = check->standard_error[c];
        const bool doubtful = difference > error[c] + suspicion * noise;
        doubtful_ = doubtful_ || (doubtful && points < most_points);
        misses_ = misses_ || check->missed[c] > most_missed * tolerance_[c];
        surprised_ = surprised_ || doubtful || !check->surprises.empty();
        // Once wrong, rules claim no smaller error than the points' own.
        slack_[c] = surprised_ ? std::min(std::max(difference, noise), tolerance_[c] / 2) : 0;
    }
    witnesses_ = std::move(check->surprises);
    for (const CubatureWitness& w : witnesses_)
        if (seen_.size() < most_seen) seen_.push_back(w);
    note_scattered_surprises(regions);
    checked_points_ = points;
    enough_points_ = true;
    for (std::size_t c = 0; request.targeted() && c < value.size(); ++c)
        enough_points_ = enough_points_ && 2 * overlooked(c) <= 1.01 * request.tolerance(c, value[c]);
    disagrees_ = false;
    for (std::size_t c = 0; c < value.size(); ++c) {
        const double difference = check->difference[c], noise = check->standard_error[c];
        if (std::abs(difference) <= error[c] + significant_errors * noise) continue;
        disagrees_ = true;
        if (rounds_ < most_rounds) add_differences(regions, *check, c);
    }
    unsurprised_ = !disagrees_ && witnesses_.empty();
    if (!unsurprised_ && rounds_ >= most_rounds) {
        witnesses_.clear();
        warning_ = "random points keep disagreeing with the rules (" + std::to_string(rounds_) + " checks)";
        return points + climbed;
    }
    if (!enough_points_ && points >= most_points) {
        witnesses_.clear();
        warning_ = "separate features are too many, or too narrow, for a check by random points";
        return points + climbed;
    }
    std::vector<std::size_t> of_regions;
    for (const CubatureWitness& w : witnesses_) of_regions.push_back(w.region);
    add_errors(regions, of_regions);
    return points + climbed;
}

void CubatureVerification::note_scattered_surprises(const CubatureRegions& regions) {
    if (problem_.evaluator.dimensions() == 1) return;
    for (std::size_t c = 0; c < scattered_.size(); ++c) {
        double sum = 0;
        std::uint64_t count = 0;
        for (const CubatureWitness& w : witnesses_) {
            const double height = surprise(regions, w.region, c, w.value[c], tolerance_[c]);
            sum += height;
            count += height > 0;
        }
        surprising_[c] += count;
        if (count > 0 && surprising_[c] >= fewest_features && std::isfinite(sum))
            scattered_[c] = sum / static_cast<double>(count);
    }
}

void CubatureVerification::note_drift(std::span<const double> value) {
    if (checked_value_.empty() || !unsurprised_) return;
    for (std::size_t c = 0; c < value.size(); ++c) {
        const double ratio =
            checked_error_[c] > 0 ? std::abs(value[c] - checked_value_[c]) / checked_error_[c] : 0;
        drift_[c] = std::isfinite(ratio) && ratio > 1 ? caution_of_drift * ratio * drift_[c] : 1;
    }
}

bool CubatureVerification::recalled(std::size_t regions) const {
    const std::size_t peaks = problem_.look ? problem_.look->peaks.size() : 0;
    return points_ == 0 || (recalled_regions_ == regions && recalled_peaks_ == peaks);
}

void CubatureVerification::update(const CubatureRegions& regions, std::span<const double> value,
                                  std::span<const double> error, const StepRequest& request) {
    if (!witnesses_.empty()) tolerance_ = tolerances(regions, value, error, request);
}

bool CubatureVerification::recall(CubatureRegions& regions, std::span<const double> value,
                                  std::span<const double> error, const StepRequest& request) {
    if (recalled(regions.count())) return false;
    recalled_regions_ = regions.count();
    recalled_peaks_ = problem_.look ? problem_.look->peaks.size() : 0;
    tolerance_ = tolerances(regions, value, error, request);
    std::vector<std::size_t> of_regions;
    auto compare = [&](std::span<const double> x, const std::vector<double>& g, double volume) {
        for (std::size_t r = 0; r < regions.count(); ++r) {
            if (!regions.touches(r, x) || regions.marks(r).indivisible) continue;
            CubatureWitness witness{r, {x.begin(), x.end()}, g, volume};
            bool open = false;
            for (std::size_t c = 0; c < g.size(); ++c) open = open || weight(regions, witness, c) > 0;
            if (!open) continue;
            of_regions.push_back(r);
            witnesses_.push_back(std::move(witness));
        }
    };
    if (problem_.look) {
        for (const Witness& w : problem_.look->witnesses) compare(w.u, w.value, w.volume);
        for (const Witness& w : problem_.look->peaks) compare(w.u, w.value, peak_widening * w.volume);
    }
    for (const CubatureWitness& w : std::vector<CubatureWitness>(seen_)) compare(w.x, w.value, w.volume);
    if (!of_regions.empty()) add_errors(regions, of_regions);
    const bool jumps = problem_.evaluator.dimensions() == 1 && raise_seam_errors(regions);
    const bool wrong = jumps || !of_regions.empty();
    unsurprised_ = unsurprised_ && !wrong;
    // Once wrong, rules claim no smaller error than the checks can show.
    for (std::size_t c = 0; wrong && c < value.size(); ++c)
        shown_[c] = shown_by_checks * request.tolerance(c, value[c]);
    return wrong;
}

void CubatureVerification::revisit(CubatureRegions& regions) {
    std::vector<std::size_t> of_regions;
    for (const CubatureWitness& w : witnesses_) of_regions.push_back(w.region);
    if (!of_regions.empty()) add_errors(regions, of_regions);
}

void CubatureVerification::claim(std::span<const double> error) {
    for (std::size_t c = 0; c < shown_.size(); ++c)
        if (std::isfinite(error[c])) shown_[c] = share_of_claim * error[c];
}

void CubatureVerification::add_differences(CubatureRegions& regions, const CubatureCheck& check,
                                           std::size_t component) {
    const std::size_t m = lowest_.size();
    for (std::size_t i = 0; i < check.regions.size(); ++i) {
        double& error = regions.error(check.regions[i])[component];
        const double difference = std::abs(check.differences[i * m + component]);
        if (difference <= error || regions.marks(check.regions[i]).indivisible) continue;
        error = difference;
        regions.marks(check.regions[i]).exhausted = false;
    }
}

void CubatureVerification::skip(std::span<const double> value, std::span<const double> error) {
    checked_value_.assign(value.begin(), value.end());
    checked_error_.assign(error.begin(), error.end());
    tolerance_.assign(error.begin(), error.end());
    warning_ = "too few evaluations are left to check the rules by random points";
}

double CubatureVerification::weight(const CubatureRegions& regions, const CubatureWitness& witness,
                                    std::size_t component) const {
    double excess =
        surprise(regions, witness.region, component, witness.value[component], tolerance_[component]);
    if (witness.x.size() == 1)
        excess = std::max(excess, surprise_near_face(regions, witness.region, component, witness.x[0],
                                                     witness.value[component]));
    const double error = std::min(regions.volume(witness.region), witness.volume) * excess;
    return error > negligible_surprise * tolerance_[component] ? error : 0;
}

void CubatureVerification::add_errors(CubatureRegions& regions, std::span<const std::size_t> of_regions) {
    std::vector<std::size_t> touched(of_regions.begin(), of_regions.end());
    std::ranges::sort(touched);
    const std::size_t m = lowest_.size();
    std::unordered_map<std::size_t, std::vector<double>> added;
    std::erase_if(witnesses_, [&](const CubatureWitness& w) {
        if (!std::ranges::binary_search(touched, w.region)) return false;
        if (regions.marks(w.region).indivisible) return true;
        bool open = false;
        std::vector<double>& sum = added.try_emplace(w.region, m, 0.0).first->second;
        for (std::size_t c = 0; c < m; ++c) {
            const double error = weight(regions, w, c);
            open = open || error > 0;
            sum[c] = std::max(sum[c], error);
        }
        return !open;
    });
    for (const auto& [region, errors] : added)
        for (std::size_t c = 0; c < m; ++c) {
            regions.error(region)[c] += errors[c];
            if (errors[c] > 0) regions.marks(region).exhausted = false;
        }
}

void CubatureVerification::follow(CubatureRegions& regions, std::span<const std::size_t> parents,
                                  std::size_t first_new) {
    if (witnesses_.empty()) return;
    std::unordered_map<std::size_t, std::size_t> upper;
    std::vector<std::size_t> touched;
    for (std::size_t p = 0; p < parents.size(); ++p) {
        upper.emplace(parents[p], first_new + p);
        touched.insert(touched.end(), {parents[p], first_new + p});
    }
    for (CubatureWitness& w : witnesses_) {
        const auto found = upper.find(w.region);
        if (found == upper.end()) continue;
        if (regions.distance(found->second, w.x) < regions.distance(w.region, w.x)) w.region = found->second;
    }
    add_errors(regions, touched);
}

void CubatureVerification::widen(std::size_t component, double& lowest, double& highest) const {
    lowest = std::min(lowest, lowest_[component]);
    highest = std::max(highest, highest_[component]);
}

double CubatureVerification::correlation(std::size_t a, std::size_t b) const {
    if (a == b) return 1;
    if (residual_.count() < 2) return 0;
    const auto i = static_cast<int>(a), j = static_cast<int>(b);
    const double product = residual_.variance(i) * residual_.variance(j);
    return product > 0 ? std::clamp(residual_.covariance(i, j) / std::sqrt(product), -1.0, 1.0) : 0;
}

void CubatureVerification::save(StateWriter& state) const {
    state.put(static_cast<std::uint64_t>(witnesses_.size()));
    for (const CubatureWitness& w : witnesses_) save_witness(state, w);
    state.put(static_cast<std::uint64_t>(seen_.size()));
    for (const CubatureWitness& w : seen_) save_witness(state, w);
    state.put(static_cast<std::uint64_t>(recalled_regions_));
    state.put(static_cast<std::uint64_t>(recalled_peaks_));
    state.put(static_cast<std::uint64_t>(checked_regions_));
    for (const auto* numbers : {&checked_value_, &checked_error_, &tolerance_, &lowest_, &highest_})
        state.put(*numbers);
    montelux::save(state, residual_);
    state.put(rounds_);
    state.put(evaluations_);
    state.put(next_);
    state.put(points_in_bulk_);
    state.put(slack_);
    state.put(shown_);
    state.put(drift_);
    state.put(static_cast<std::uint64_t>(features_));
    state.put(scattered_);
    state.put_all(surprising_);
    state.put(checked_points_);
    state.put(enough_points_);
    state.put(unsurprised_);
    state.put(surprised_);
    state.put(disagrees_);
    state.put(doubtful_);
    state.put(misses_);
    montelux::save(state, non_finite_);
    state.put(std::string_view(warning_));
}

void CubatureVerification::load(StateReader& state, std::size_t regions) {
    const std::size_t m = lowest_.size();
    auto fits = [](const std::vector<double>& numbers, std::size_t size) {
        if (numbers.size() != size) throw Error("the saved state has another number of components");
    };
    for (auto* all : {&witnesses_, &seen_}) {
        all->clear();
        for (std::uint64_t n = state.get_word(); n > 0; --n) {
            CubatureWitness w;
            w.region = state.get_word();
            w.x = state.get_doubles();
            w.value = state.get_doubles();
            w.volume = state.get_double();
            fits(w.x, static_cast<std::size_t>(problem_.evaluator.dimensions()));
            fits(w.value, m);
            if (w.region >= regions) throw Error("the saved state is damaged");
            all->push_back(std::move(w));
        }
    }
    recalled_regions_ = state.get_word();
    recalled_peaks_ = state.get_word();
    checked_regions_ = state.get_word();
    for (auto* numbers : {&checked_value_, &checked_error_, &tolerance_, &lowest_, &highest_})
        *numbers = state.get_doubles();
    for (const auto* numbers : {&checked_value_, &checked_error_, &tolerance_})
        if (!numbers->empty()) fits(*numbers, m);
    fits(lowest_, m);
    fits(highest_, m);
    montelux::load(state, residual_);
    rounds_ = state.get_word();
    evaluations_ = state.get_word();
    next_ = state.get_word();
    points_in_bulk_ = state.get_double();
    slack_ = state.get_doubles();
    shown_ = state.get_doubles();
    fits(shown_, m);
    drift_ = state.get_doubles();
    fits(drift_, m);
    features_ = state.get_word();
    scattered_ = state.get_doubles();
    fits(scattered_, m);
    surprising_ = state.get_all<std::uint64_t>();
    if (surprising_.size() != m) throw Error("the saved state has another number of components");
    checked_points_ = state.get_word();
    enough_points_ = state.get<bool>();
    unsurprised_ = state.get<bool>();
    surprised_ = state.get<int>() != 0;
    if (!slack_.empty()) fits(slack_, m);
    disagrees_ = state.get<int>() != 0;
    doubtful_ = state.get<bool>();
    misses_ = state.get<bool>();
    montelux::load(state, non_finite_);
    warning_ = state.get_text();
}

} // namespace montelux
