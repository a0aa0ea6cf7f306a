// A baked texel: value, error, and stopping rule.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "montelux/mc/math/vec.h"

namespace montelux {

// Stopping rule of a texel.
struct TexelTarget {
    // Standard error of each channel relative to the larger of the mean of the three channels and `floor`; 0:
    // none.
    double target_error = 0.01;
    double floor = 0; // in radiance
    // Without a target, the number of samples; with one, the limit per round.
    std::uint64_t samples = 1 << 20;
};

struct TexelEstimate {
    Vec3d value, standard_error;
    std::uint64_t samples = 0; // in all rounds
    bool met = true;
};

// Sum of strata with a few samples each, and its standard error. Two samples give their variance one degree
// of freedom, and few strata may hold most of it: the error is by Student's law with Satterthwaite's (1946)
// degrees of freedom nu of the sum, so that the mean square of deviation over error is 1.
class StratifiedSum {
  public:
    // At least two samples of one stratum, which contributes their mean.
    void add(std::span<const Vec3d> samples) {
        const auto n = static_cast<double>(samples.size());
        Vec3d mean, squares;
        for (const Vec3d& s : samples) mean += s * (1 / n);
        for (const Vec3d& s : samples) squares += multiply(s - mean, s - mean);
        const Vec3d variance = squares * (1 / (n * (n - 1))); // of the mean
        value_ += mean;
        variance_ += variance;
        // The mean of s^4 is (n + 1) / (n - 1) sigma^4 for normal samples.
        inverse_ += multiply(variance, variance) * (1 / (n + 1));
    }
    Vec3d value() const { return value_; }
    Vec3d standard_error() const {
        return {widened(variance_.x, inverse_.x), widened(variance_.y, inverse_.y),
                widened(variance_.z, inverse_.z)};
    }

  private:
    // 1 / nu = inverse / variance^2, at most 1/3; the variance of Student's law is nu / (nu - 2).
    static double widened(double variance, double inverse) {
        return variance > 0 ? std::sqrt(variance / (1 - 2 * inverse / (variance * variance))) : 0;
    }

    Vec3d value_, variance_, inverse_;
};

// Error over the target's; 0 for a black texel without error, infinite if value or error is not finite.
inline double missed_by(const TexelEstimate& e, const TexelTarget& target, double target_error) {
    const double reference = std::max((e.value.x + e.value.y + e.value.z) / 3, target.floor);
    double finite = 0; // or NaN
    for (int c = 0; c < 3; ++c) finite += 0 * (e.value[c] + e.standard_error[c]);
    if (finite != 0) return std::numeric_limits<double>::infinity();
    const double error = max_component(e.standard_error);
    if (error == 0) return 0;
    return reference > 0 ? error / (target_error * reference) : 2;
}
inline bool meets(const TexelEstimate& e, const TexelTarget& target) {
    return missed_by(e, target, target.target_error) <= 1;
}

} // namespace montelux
