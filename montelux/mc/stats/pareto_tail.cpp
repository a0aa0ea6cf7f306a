#include "montelux/mc/stats/pareto_tail.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

namespace montelux {
namespace {

constexpr std::size_t least_points = 20;
constexpr double rounding = 1e-9; // spread of a tail over its size, below which values count as equal
constexpr double prior_points = 10, prior_shape = 0.5;

} // namespace

double ParetoFit::shape_error() const { return std::max(0.0, 1 + shape) / std::sqrt(points); }

std::optional<ParetoFit> fit_pareto(std::span<const double> exceedances) {
    const std::size_t n = exceedances.size();
    if (n < least_points) return std::nullopt;
    const double quartile = exceedances[(n + 2) / 4 - 1], largest = exceedances.back();
    if (!(quartile > 0 && std::isfinite(largest))) return std::nullopt;
    // In units of the largest, so that nothing over- or underflows.
    auto shape_for = [&](double theta) {
        // The logarithm of a product, cut where it might leave the range of doubles.
        constexpr double far = 1e100;
        double sum = 0, product = 1;
        for (double x : exceedances) {
            product *= 1 - theta * (x / largest);
            if (product < far && product > 1 / far) continue;
            sum += std::log(product);
            product = 1;
        }
        return (sum + std::log(product)) / static_cast<double>(n);
    };
    // Values of theta = -shape / scale, weighted by their profile likelihood.
    const auto m = 30 + static_cast<std::size_t>(std::sqrt(static_cast<double>(n)));
    std::vector<double> theta(m), log_likelihood(m);
    for (std::size_t i = 0; i < m; ++i) {
        theta[i] = 1 + (1 - std::sqrt(static_cast<double>(m) / (static_cast<double>(i) + 0.5))) /
                           (3 * (quartile / largest));
        const double k = shape_for(theta[i]);
        log_likelihood[i] = theta[i] == 0 ? 0 : static_cast<double>(n) * (std::log(-theta[i] / k) - k - 1);
    }
    double mean = 0, total = 0;
    const double best = *std::max_element(log_likelihood.begin(), log_likelihood.end());
    for (std::size_t i = 0; i < m; ++i) {
        const double weight = std::exp(log_likelihood[i] - best);
        total += weight;
        mean += weight * theta[i];
    }
    mean /= total;
    if (!std::isfinite(mean) || mean == 0) return std::nullopt;
    const double k = shape_for(mean);
    const double points = static_cast<double>(n);
    return ParetoFit{.shape = (points * k + prior_points * prior_shape) / (points + prior_points),
                     .scale = -k / mean * largest,
                     .threshold = 0,
                     .points = static_cast<int>(n)};
}

ParetoTail ParetoTail::empty() const {
    ParetoTail tail(capacity_);
    tail.floor_ = floor_;
    return tail;
}

void ParetoTail::insert(double value) {
    kept_.push_back(value);
    known_.reset();
    if (kept_.size() >= 2 * capacity_) prune();
}

void ParetoTail::prune() {
    const auto last = kept_.begin() + static_cast<std::ptrdiff_t>(capacity_) - 1;
    std::nth_element(kept_.begin(), last, kept_.end(), std::greater<>());
    floor_ = *last;
    kept_.resize(capacity_);
}

std::vector<double> ParetoTail::values() const {
    std::vector<double> sorted = kept_;
    std::sort(sorted.begin(), sorted.end(), std::greater<>());
    sorted.resize(std::min(sorted.size(), capacity_));
    return sorted;
}

void ParetoTail::restore(std::vector<double> values) {
    kept_ = std::move(values);
    known_.reset();
    floor_ = 0;
    if (kept_.size() >= capacity_) prune();
}

std::optional<ParetoFit> ParetoTail::fit(std::uint64_t n) const {
    if (!known_ || known_->n != n) known_ = Known{n, fit_anew(n)};
    return known_->fit;
}

std::optional<ParetoFit> ParetoTail::fit_anew(std::uint64_t n) const {
    const std::vector<double> sorted = values();
    const double points = std::min(3 * std::sqrt(static_cast<double>(n)), static_cast<double>(n) / 5);
    // The largest value below the tail is its threshold.
    const std::size_t m = std::min(static_cast<std::size_t>(points), sorted.empty() ? 0 : sorted.size() - 1);
    if (m == 0) return std::nullopt;
    const double threshold = sorted[m];
    if (!(sorted.front() - threshold > rounding * sorted.front())) return std::nullopt;
    std::vector<double> exceedances(m);
    for (std::size_t i = 0; i < m; ++i) exceedances[m - 1 - i] = sorted[i] - threshold;
    std::optional<ParetoFit> fit = fit_pareto(exceedances);
    if (fit) fit->threshold = threshold;
    return fit;
}

} // namespace montelux
