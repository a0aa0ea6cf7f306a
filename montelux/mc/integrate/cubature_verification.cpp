#include "montelux/mc/integrate/cubature_verification.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <unordered_map>
#include <utility>

#include "montelux/mc/integrate/sampling.h"

namespace montelux {
namespace {

constexpr double negligible = 0.02;      // share of the tolerance
constexpr double least_tolerance = 1e-7; // share of the integral of the absolute value
constexpr double significance = 6;       // standard errors between rules and points
constexpr std::uint64_t most_rounds = 12;
constexpr std::uint64_t fewest_points = 16;
constexpr double plateau = 0.1;             // range of the values beside their mean
constexpr std::uint64_t plateau_points = 4; // times as many points where nothing but a plateau was seen
constexpr double infinity = std::numeric_limits<double>::infinity();

bool targeted(const StepRequest& request) { return request.relative_error > 0 || request.absolute_error > 0; }

} // namespace

CubatureVerification::CubatureVerification(const Problem& problem, std::uint64_t points)
    : problem_(problem), points_(points), residual_(problem.evaluator.components(), problem.full_covariance),
      lowest_(static_cast<std::size_t>(problem.evaluator.components()), infinity),
      highest_(lowest_.size(), -infinity), next_(4 * points) {}

bool CubatureVerification::verified(std::span<const double> value) const {
    if (points_ == 0) return true;
    if (checked_value_.empty() || !witnesses_.empty()) return false;
    if (!warning_.empty()) return true; // no further check would help
    for (std::size_t c = 0; c < value.size(); ++c)
        if (!(std::abs(value[c] - checked_value_[c]) <= checked_error_[c])) return false;
    return true;
}

bool CubatureVerification::due(const CubatureRegions& regions, std::span<const double> value,
                               std::span<const double> error, std::uint64_t evaluations,
                               const StepRequest& request, bool claimed) const {
    if (points_ == 0 || !warning_.empty() || !witnesses_.empty()) return false;
    bool fresh = !verified(value);
    if (!fresh) { // a tighter target sees smaller surprises
        const std::vector<double> now = tolerances(regions, value, error, request);
        for (std::size_t c = 0; c < now.size(); ++c) fresh = fresh || now[c] < 0.5 * tolerance_[c];
    }
    if (!fresh) return false;
    if (claimed) return true;
    if (targeted(request)) return false;
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
    const std::uint64_t wanted = flat ? plateau_points * points_ : points_;
    const std::uint64_t all = evaluations + request.max_evaluations;
    const std::uint64_t points =
        std::min({wanted, all / (targeted(request) ? 2 : 8), request.max_evaluations});
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
        // No error relative to a value that vanishes can be asked for.
        tolerance[c] = std::max(error[c], least_tolerance * size);
        if (targeted(request))
            tolerance[c] =
                std::max({tolerance[c], request.absolute_error, request.relative_error * std::abs(value[c])});
    }
    return tolerance;
}

bool CubatureVerification::run(CubatureRegions& regions, std::span<const double> value,
                               std::span<const double> error, std::uint64_t points,
                               const StepRequest& request) {
    std::vector<double> tolerance = tolerances(regions, value, error, request);
    auto check = check_regions(problem_.evaluator, regions, points, problem_.seed, rounds_, tolerance,
                               problem_.full_covariance, request.cancel);
    if (!check) return false;
    ++rounds_;
    evaluations_ += points;
    non_finite_.merge(check->non_finite);
    next_ = 8 * std::max(next_, points);
    tolerance_ = std::move(tolerance);
    residual_ = std::move(check->residual);
    checked_value_.assign(value.begin(), value.end());
    checked_error_.assign(error.begin(), error.end());
    for (std::size_t c = 0; c < lowest_.size(); ++c) {
        lowest_[c] = std::min(lowest_[c], check->lowest[c]);
        highest_[c] = std::max(highest_[c], check->highest[c]);
    }
    witnesses_ = std::move(check->surprises);
    if (!witnesses_.empty() && rounds_ >= most_rounds) {
        witnesses_.clear();
        warning_ = "random points keep meeting values that the rules do not expect (" +
                   std::to_string(rounds_) + " checks)";
        return true;
    }
    std::vector<std::size_t> of_regions;
    for (const CubatureWitness& w : witnesses_) of_regions.push_back(w.region);
    add_errors(regions, of_regions);
    if (!witnesses_.empty()) return true;
    for (std::size_t c = 0; c < value.size(); ++c) {
        const double difference = residual_.mean(static_cast<int>(c)), noise = check->standard_error[c];
        if (std::abs(difference) <= error[c] + significance * noise) continue;
        char text[160];
        std::snprintf(
            text, sizeof text,
            "%llu random points give %.3g, which is %.1f standard errors from the value of the rules",
            static_cast<unsigned long long>(points), value[c] + difference, std::abs(difference) / noise);
        warning_ = text;
        break;
    }
    return true;
}

void CubatureVerification::skip(std::span<const double> value, std::span<const double> error) {
    checked_value_.assign(value.begin(), value.end());
    checked_error_.assign(error.begin(), error.end());
    tolerance_.assign(error.begin(), error.end());
    warning_ = "too few evaluations are left to check the rules by random points";
}

double CubatureVerification::weight(const CubatureRegions& regions, const CubatureWitness& witness,
                                    std::size_t component) const {
    const double excess =
        surprise(regions, witness.region, component, witness.value[component], tolerance_[component]);
    const double error = regions.volume(witness.region) * excess;
    return error > negligible * tolerance_[component] ? error : 0;
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
        for (std::size_t d = 0; d < w.x.size(); ++d)
            if (std::abs(w.x[d] - regions.centre(w.region)[d]) > regions.half_width(w.region)[d])
                w.region = found->second;
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
    for (const CubatureWitness& w : witnesses_) {
        state.put(static_cast<std::uint64_t>(w.region));
        state.put(w.x);
        state.put(w.value);
    }
    for (const auto* numbers : {&checked_value_, &checked_error_, &tolerance_, &lowest_, &highest_})
        state.put(*numbers);
    montelux::save(state, residual_);
    state.put(rounds_);
    state.put(evaluations_);
    state.put(next_);
    montelux::save(state, non_finite_);
    state.put(std::string_view(warning_));
}

void CubatureVerification::load(StateReader& state, std::size_t regions) {
    const std::size_t m = lowest_.size();
    auto fits = [](const std::vector<double>& numbers, std::size_t size) {
        if (numbers.size() != size) throw Error("the saved state has another number of components");
    };
    witnesses_.clear();
    for (std::uint64_t n = state.get_word(); n > 0; --n) {
        CubatureWitness w;
        w.region = state.get_word();
        w.x = state.get_doubles();
        w.value = state.get_doubles();
        fits(w.x, static_cast<std::size_t>(problem_.evaluator.dimensions()));
        fits(w.value, m);
        if (w.region >= regions) throw Error("the saved state is damaged");
        witnesses_.push_back(std::move(w));
    }
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
    montelux::load(state, non_finite_);
    warning_ = state.get_text();
}

} // namespace montelux
