// A value with its standard error, as every estimator of the library returns it.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>

#include "montelux/mc/stats/moments.h"

namespace montelux {

struct Interval {
    double lower = 0, upper = 0;

    bool contains(double x) const { return x >= lower && x <= upper; }
};

struct Estimate {
    double value = 0;
    // One standard deviation of `value`; infinite when too few samples were drawn to know it.
    double standard_error = 0;
    // Calls of the integrand.
    std::uint64_t evaluations = 0;
    // Samples that were NaN or infinite: left out of the sum as zeros, and counted here. A value with
    // any of them is suspect.
    std::uint64_t non_finite = 0;
    // Index of the first of them, so that it can be replayed alone.
    static constexpr std::uint64_t no_index = ~std::uint64_t{0};
    std::uint64_t first_non_finite = no_index;

    // Standard error relative to the value.
    double relative_error() const { return standard_error / std::abs(value); }
    // The interval that holds the truth with this probability, by the normal law of a mean of many samples.
    Interval confidence_interval(double level = 0.95) const;
    // (value - truth) / standard_error.
    double z_score(double truth) const { return (value - truth) / standard_error; }

    // The mean of independent samples with these moments.
    static Estimate from_moments(const RunningMoments& moments, std::uint64_t non_finite = 0,
                                 std::uint64_t first_non_finite = no_index) {
        return {moments.mean(), moments.standard_error(), moments.count(), non_finite, first_non_finite};
    }
};

// Concise notation: the digits in brackets are the standard error in units of the last digits shown, so
// 1.2345(67) is 1.2345 +- 0.0067; large and small values carry a power of ten. Non-finite samples follow.
std::string to_string(const Estimate& estimate);
std::ostream& operator<<(std::ostream& out, const Estimate& estimate);

} // namespace montelux
