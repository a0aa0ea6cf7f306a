// The extreme values among samples, and a lower bound on the error of a mean that follows from them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "montelux/mc/integrate/state_archive.h"
#include "montelux/mc/stats/pareto_tail.h"

namespace montelux {

struct DeviceSummary;

// The factor by which a standard error is too small if its variance comes from only k independent values,
// since others like them may not have been drawn: 1 + 1.32 k^-1.5. With it, k hits of a rare event are more
// than four errors from their expectation with a probability below 0.3 %, as for one hit where 10 are
// expected (there the factor is the upper limit of Gehrels 1986, "Confidence limits for small numbers of
// events").
double few_values_factor(double k);
// The standard error of a mean of n values that are all equal: half of the rule of three, a bound of 95 %.
inline double equal_values_error(double value, double n) { return 1.5 * (value < 0 ? -value : value) / n; }

// Part of the mean of n values that lies beyond the largest of them if they follow a tail of a shape from 0.4 on, where
// the spread of the values no longer tells: w / n k / (1 - k) for the largest w and the shape k; else 0.
double beyond_the_largest(const ParetoTail& tail, std::uint64_t values, double n);

// Adds a warning if the largest of `values` values follow a tail whose variance is probably infinite and
// contribute to the standard error of a mean in which each has weight 1 / n.
void warn_of_heavy_tail(const ParetoTail& tail, std::uint64_t values, double n, double standard_error,
                        std::vector<std::string>& warnings);

// Sums and extremes of the values of each component; of the first component the tail of the magnitudes too.
class ExtremeValues {
  public:
    ExtremeValues() = default;
    explicit ExtremeValues(int components);

    int components() const { return static_cast<int>(components_.size()); }
    void add(int component, std::span<const double> values);
    // Values of the one component that a device has summarised; none is above the tail's floor.
    void add(const DeviceSummary& values, std::uint64_t count);
    void merge(const ExtremeValues& later);
    // An empty one, to be filled and merged into this one.
    ExtremeValues empty() const;
    const ParetoTail& tail() const { return tail_; }
    // Magnitude of the first component; 0 without values.
    double largest() const;
    // Of n values of a component from their mean, 0 if they are equal but for rounding; values that were not
    // added count as zeros.
    double largest_deviation(int component, std::uint64_t n) const;

    // Lower bound on the standard error of the mean of n independent values, if only few of them (hits of a
    // rare event, misses of a common one) contribute to the variance, or if all are equal; else 0, and 0 if
    // all are zero. Values that were not added count as zeros.
    double least_standard_error(int component, std::uint64_t n) const;
    // Mean of the magnitudes of n values of a component.
    double mean_magnitude(int component, std::uint64_t n) const;

    void save(StateWriter& state) const;
    // Throws Error where the saved number of components differs.
    void load(StateReader& state);

  private:
    struct Component {
        std::uint64_t count = 0;
        double least, greatest, sum = 0, squares = 0, magnitudes = 0;
    };
    std::vector<Component> components_;
    ParetoTail tail_;
};

} // namespace montelux
