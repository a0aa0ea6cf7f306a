#include "montelux/mc/integrate/extreme_values.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "montelux/mc/device/device_job.h"
#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/integrate/lane_sum.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

constexpr double few = 16, few_of_all = 1 / 16.; // values that contribute most of a variance
constexpr double all_equal = 1e-13;              // deviation over mean: rounding
constexpr double infinite_variance = 0.5;        // shape from which there is none
constexpr double heavy_shape = 0.4,
                 heaviest_shape = 0.95; // of tails whose part beyond the largest value counts
constexpr double shape_errors = 1.5;    // by which the fitted shape must exceed it
constexpr int least_tail = 50;          // points that must have been fitted
constexpr double tail_share = 0.2;      // of the tail in the squared error, to matter

} // namespace

double few_values_factor(double k) { return 1 + 1.32 * std::pow(std::max(k, 1.0), -1.5); }

double beyond_the_largest(const ParetoTail& tail, std::uint64_t values, double n) {
    const std::optional<ParetoFit> fit = tail.fit(values);
    if (!fit || fit->points < least_tail || !(fit->shape > heavy_shape)) return 0;
    const double k = std::min(fit->shape, heaviest_shape);
    return tail.values().front() / n * k / (1 - k);
}

void warn_of_heavy_tail(const ParetoTail& tail, std::uint64_t values, double n, double standard_error,
                        std::vector<std::string>& warnings) {
    const std::optional<ParetoFit> fit = tail.fit(values);
    if (!fit || fit->points < least_tail ||
        !(fit->shape - shape_errors * fit->shape_error() > infinite_variance))
        return;
    const std::vector<double> largest = tail.values();
    const double squares = lane_sum(static_cast<std::size_t>(fit->points), [&](std::size_t i) {
        return std::pow((largest[i] - fit->threshold) / n, 2);
    });
    if (!(squares > tail_share * standard_error * standard_error)) return;
    char text[160];
    std::snprintf(text, sizeof text,
                  "the largest weights have a Pareto tail with k = %.2f: the variance may be infinite and "
                  "the error too small",
                  fit->shape);
    warnings.emplace_back(text);
}

ExtremeValues::ExtremeValues(int components)
    : components_(static_cast<std::size_t>(components), {0, infinity, -infinity}) {}

void ExtremeValues::add(int component, std::span<const double> values) {
    Component& c = components_[static_cast<std::size_t>(component)];
    c.count += values.size();
    c.sum += lane_sum(values.size(), [&](std::size_t i) { return values[i]; });
    c.squares += lane_sum(values.size(), [&](std::size_t i) { return values[i] * values[i]; });
    c.magnitudes += lane_sum(values.size(), [&](std::size_t i) { return std::abs(values[i]); });
    double least = c.least, greatest = c.greatest;
    for (double v : values) {
        least = std::min(least, v);
        greatest = std::max(greatest, v);
    }
    c.least = least;
    c.greatest = greatest;
    if (component > 0) return;
    for (double v : values) tail_.add(std::abs(v));
}

void ExtremeValues::add(const DeviceSummary& values, std::uint64_t count) {
    Component& c = components_.front();
    c.count += count;
    c.sum += values.sum;
    c.squares += values.squares;
    // Exact for values of one sign; else a bound, since a device does not sum magnitudes.
    c.magnitudes += values.least >= 0 || values.greatest <= 0
                        ? std::abs(values.sum)
                        : std::sqrt(values.squares * static_cast<double>(count));
    c.least = std::min(c.least, values.least);
    c.greatest = std::max(c.greatest, values.greatest);
}

void ExtremeValues::merge(const ExtremeValues& later) {
    for (std::size_t k = 0; k < components_.size(); ++k) {
        Component& c = components_[k];
        const Component& l = later.components_[k];
        c.count += l.count;
        c.sum += l.sum;
        c.squares += l.squares;
        c.magnitudes += l.magnitudes;
        c.least = std::min(c.least, l.least);
        c.greatest = std::max(c.greatest, l.greatest);
    }
    tail_.merge(later.tail_);
}

ExtremeValues ExtremeValues::empty() const {
    ExtremeValues none(components());
    none.tail_ = tail_.empty();
    return none;
}

double ExtremeValues::largest() const {
    const Component& c = components_.front();
    return std::max({c.greatest, -c.least, 0.0});
}

double ExtremeValues::largest_deviation(int component, std::uint64_t values) const {
    const Component& c = components_[static_cast<std::size_t>(component)];
    if (values == 0) return 0;
    const double zero = c.count < values ? 0 : c.least;
    const double mean = c.sum / static_cast<double>(values);
    const double deviation = std::max(std::max(c.greatest, zero) - mean, mean - std::min(c.least, zero));
    return deviation > all_equal * std::abs(mean) ? deviation : 0;
}

double ExtremeValues::least_standard_error(int component, std::uint64_t values) const {
    const Component& c = components_[static_cast<std::size_t>(component)];
    if (values == 0) return 0;
    const double n = static_cast<double>(values), mean = c.sum / n;
    const double largest = largest_deviation(component, values);
    if (!(largest > 0)) return equal_values_error(mean, n);
    const double k = std::max(0.0, c.squares - n * mean * mean) / (largest * largest);
    if (!(k < few) || !(k < few_of_all * n)) return 0;
    return std::sqrt(std::max(k, 1.0)) * largest / n * few_values_factor(k);
}

double ExtremeValues::mean_magnitude(int component, std::uint64_t values) const {
    return components_[static_cast<std::size_t>(component)].magnitudes /
           static_cast<double>(std::max<std::uint64_t>(values, 1));
}

void ExtremeValues::save(StateWriter& state) const {
    state.put(static_cast<std::uint64_t>(components_.size()));
    for (const Component& c : components_) {
        state.put(c.count);
        for (double x : {c.least, c.greatest, c.sum, c.squares, c.magnitudes}) state.put(x);
    }
    state.put(tail_.values());
}

void ExtremeValues::load(StateReader& state) {
    if (state.get_word() != components_.size())
        throw Error("the saved state has another number of components");
    for (Component& c : components_) {
        c.count = state.get_word();
        for (double* x : {&c.least, &c.greatest, &c.sum, &c.squares, &c.magnitudes}) *x = state.get_double();
    }
    tail_.restore(state.get_doubles());
}

} // namespace montelux
