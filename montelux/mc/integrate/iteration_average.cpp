#include "montelux/mc/integrate/iteration_average.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "montelux/mc/integrate/sampling.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/special.h"

namespace montelux {
namespace {

constexpr double few_points = 1 / 16.; // points behind the variance, below which they count as few
constexpr double chi_squared_significance = 1e-3;
// Relative to the value: rounding must not make constants disagree with themselves.
constexpr double rounding_error = 1e-13;

} // namespace

IterationEstimate IterationEstimate::zero(int components, bool full_covariance) {
    const auto m = static_cast<std::size_t>(components);
    return {std::vector<double>(m), std::vector<double>(m * (full_covariance ? m : 1)), 0,
            std::vector<double>(m), 0};
}

void IterationEstimate::add_mean(const CovarianceMoments& samples) {
    const std::size_t m = value.size();
    const bool full = samples.full();
    const double n = static_cast<double>(samples.count());
    for (std::size_t a = 0; a < m; ++a) {
        value[a] += samples.means()[a];
        for (std::size_t b = full ? 0 : a; b <= a; ++b)
            covariance[full ? a * m + b : a] +=
                samples.covariance(static_cast<int>(a), static_cast<int>(b)) / n;
    }
}

void IterationEstimate::add_mean(const SampleMoments& samples) {
    add_mean(samples.moments);
    const std::uint64_t n = samples.moments.count();
    bool equal = true; // but for rounding: exact, as a combination of controls is
    for (std::size_t c = 0; c < value.size(); ++c) {
        const double deviation = samples.extremes.largest_deviation(static_cast<int>(c), n);
        const double share = deviation / static_cast<double>(n);
        equal = equal && !(deviation > rounding_error * std::abs(value[c]));
        largest_variance[c] = std::max(largest_variance[c], share * share);
    }
    if (!equal) points += static_cast<double>(n);
}

IterationAverage::IterationAverage(int components, bool full_covariance)
    : full_(full_covariance), value_(static_cast<std::size_t>(components)),
      covariance_(value_.size() * (full_covariance ? value_.size() : 1)), chi_squared_(value_),
      terms_(value_), square_trace_(value_), cube_trace_(value_), pairs_(value_), triples_(value_),
      largest_(value_) {}

double IterationAverage::variance(int component) const {
    const auto c = static_cast<std::size_t>(component);
    return covariance_[full_ ? c * value_.size() + c : c] / (weight_ * weight_);
}

double IterationAverage::p_value(int component) const {
    const auto c = static_cast<std::size_t>(component);
    const double square = square_trace_[c], cube = cube_trace_[c];
    if (!(square > 0)) return 1; // nothing differs
    const double n = square * square / cube * (square / cube);
    const double q = n + (chi_squared_[c] - terms_[c]) * std::sqrt(n / square);
    return q > 0 ? chi_squared_p_value(q, n) : 1;
}

void IterationAverage::add(double weight, const IterationEstimate& iteration) {
    compare(weight, iteration);
    ++iterations_;
    weight_ += weight;
    for (std::size_t c = 0; c < value_.size(); ++c)
        value_[c] += weight / weight_ * (iteration.value[c] - value_[c]);
    for (std::size_t k = 0; k < covariance_.size(); ++k)
        covariance_[k] += weight * weight * iteration.covariance[k];
    for (std::size_t c = 0; c < iteration.largest_variance.size(); ++c)
        largest_[c] = std::max(largest_[c], weight * weight * iteration.largest_variance[c]);
    points_ += iteration.points;
}

void IterationAverage::compare(double weight, const IterationEstimate& iteration) {
    if (iterations_ == 0) return;
    for (std::size_t c = 0; c < value_.size(); ++c) {
        const double own = iteration.covariance[full_ ? c * value_.size() + c : c];
        const double of_mean = variance(static_cast<int>(c));
        const double rounding = rounding_error * value_[c];
        const double sum = own + of_mean + rounding * rounding;
        if (!(sum > 0)) continue;
        double z = std::abs(iteration.value[c] - value_[c]) / std::sqrt(sum);
        // Student's law where the variance comes from a few replicates, carried over to the normal one.
        if (iteration.degrees_of_freedom > 0)
            z = -normal_quantile(std::max(1e-300, student_t_cdf(-z, iteration.degrees_of_freedom)));
        chi_squared_[c] += z * z;
        // By the differences before: squares of correlations, and products around triangles.
        const double per_weight = 1 / (weight_ * weight_ * sum);
        const double squares = pairs_[c] * per_weight, products = triples_[c] * per_weight;
        terms_[c] += 1;
        square_trace_[c] += 1 + 2 * squares;
        cube_trace_[c] += 1 + 6 * squares + 6 * products;
        const double a = of_mean * weight_ - weight * own;
        triples_[c] += a / (sum * weight_) * pairs_[c];
        pairs_[c] += a / sum * a;
    }
    ++degrees_of_freedom_;
}

void IterationAverage::tally(Tally& tally) const {
    tally.value = value_;
    tally.standard_error.assign(value_.size(), std::numeric_limits<double>::infinity());
    tally.ready = iterations_ > 0;
    if (iterations_ == 0) return;
    for (std::size_t c = 0; c < value_.size(); ++c)
        tally.standard_error[c] = std::sqrt(variance(static_cast<int>(c)));
    tally.covariance.clear();
    const std::size_t m = value_.size();
    if (full_)
        for (std::size_t a = 0; a < m; ++a)
            for (std::size_t b = 0; b < m; ++b)
                tally.covariance.push_back(covariance_[std::max(a, b) * m + std::min(a, b)] /
                                           (weight_ * weight_));
    std::vector<double> least(m);
    for (std::size_t c = 0; c < m; ++c) {
        const double error = tally.standard_error[c], largest = largest_[c] / (weight_ * weight_);
        const double k = largest > 0 ? error * error / largest : points_;
        least[c] = k < few_points * points_ ? error * few_values_factor(k) : 0;
        if (points_ > 0 && !(error > rounding_error * std::abs(value_[c])))
            least[c] = equal_values_error(value_[c], points_);
    }
    raise_standard_errors(least, tally);
    tally.degrees_of_freedom = degrees_of_freedom_;
    if (degrees_of_freedom_ == 0) return;
    for (std::size_t c = 0; c < m; ++c) {
        const double p = p_value(static_cast<int>(c));
        if (c > 0 && p >= tally.p_value) continue;
        tally.p_value = p;
        tally.chi_squared = chi_squared_[c];
    }
    const double p = tally.p_value;
    if (p * static_cast<double>(m) >= chi_squared_significance) return;
    char text[192];
    std::snprintf(text, sizeof text,
                  "the iterations disagree: chi-squared %.3g for %d degrees of freedom, p = %.2g",
                  tally.chi_squared, degrees_of_freedom_, p);
    tally.warnings.emplace_back(text);
}

void IterationAverage::save(StateWriter& state) const {
    state.put(iterations_);
    state.put(weight_);
    state.put(value_);
    state.put(covariance_);
    state.put(chi_squared_);
    state.put(terms_);
    state.put(square_trace_);
    state.put(cube_trace_);
    state.put(pairs_);
    state.put(triples_);
    state.put(largest_);
    state.put(points_);
    state.put(degrees_of_freedom_);
}

void IterationAverage::load(StateReader& state) {
    iterations_ = state.get<int>();
    weight_ = state.get_double();
    for (std::vector<double>* part : {&value_, &covariance_, &chi_squared_, &terms_, &square_trace_,
                                      &cube_trace_, &pairs_, &triples_, &largest_}) {
        std::vector<double> numbers = state.get_doubles();
        if (numbers.size() != part->size()) throw Error("the saved state has another number of components");
        *part = std::move(numbers);
    }
    points_ = state.get_double();
    degrees_of_freedom_ = state.get<int>();
}

} // namespace montelux
