// The largest of many values, and the generalised Pareto law of their tail.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace montelux {

// A generalised Pareto law: P(X > threshold + x | X > threshold) = (1 + shape x / scale)^(-1 / shape).
// Moments of order 1 / shape and higher do not exist: the variance is infinite from shape 0.5, the mean
// from 1.
struct ParetoFit {
    double shape = 0, scale = 0, threshold = 0;
    int points = 0; // above the threshold

    // One standard deviation of the shape, asymptotically.
    double shape_error() const;
};

// Fits the law to exceedances over a threshold, ascending and not negative, by the empirical Bayes estimate
// of Zhang and Stephens 2009, "A New and Efficient Estimation Method for the Generalized Pareto
// Distribution"; the shape is drawn towards 0.5 with the weight of ten points, as by Vehtari, Simpson,
// Gelman, Yao and Gabry 2024, "Pareto Smoothed Importance Sampling". Nothing where there are too few points,
// or where so many of them are equal to the threshold that there is no tail.
std::optional<ParetoFit> fit_pareto(std::span<const double> exceedances);

// The largest `capacity` of all values added. The result does not depend on the order or grouping of values.
class ParetoTail {
  public:
    ParetoTail() = default;
    explicit ParetoTail(std::size_t capacity) : capacity_(capacity) {}

    // Values must not be NaN.
    void add(double value) {
        if (value > floor_) insert(value);
    }
    void add(std::span<const double> values) {
        for (double v : values) add(v);
    }
    void merge(const ParetoTail& other) { add(other.kept_); }
    // An empty one, which ignores values that could not enter this one after a merge.
    ParetoTail empty() const;

    std::size_t capacity() const { return capacity_; }
    // Smaller and equal values are ignored.
    double floor() const { return floor_; }
    // Descending.
    std::vector<double> values() const;
    void restore(std::vector<double> values);

    // The law of the tail of n values, of which these are the largest: of the 3 sqrt(n) largest, but of no
    // more than a fifth and no more than are kept. Remembers its answer: for one thread at a time.
    std::optional<ParetoFit> fit(std::uint64_t n) const;

  private:
    std::optional<ParetoFit> fit_anew(std::uint64_t n) const;
    void insert(double value);
    void prune();

    std::size_t capacity_ = 1024;
    double floor_ = 0;         // smaller values are not among the largest
    std::vector<double> kept_; // in no order, less than twice the capacity
    struct Known {
        std::uint64_t n;
        std::optional<ParetoFit> fit;
    };
    mutable std::optional<Known> known_; // of the values kept now
};

} // namespace montelux
