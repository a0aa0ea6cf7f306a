// Running mean, variance and skewness in one pass: errors of estimates whose samples are far from Gaussian.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "montelux/mc/math/vec.h"

namespace montelux {

// Central moments up to the third of `Channels` quantities that are sampled together, in double precision.
// Pebay 2008, "Formulas for Robust, One-Pass Parallel Computation of Covariances and Arbitrary-Order
// Statistical Moments", Sandia report SAND2008-6212, equations 1.5 and 2.1. Values must be finite.
template <int Channels>
class SkewMoments {
  public:
    SkewMoments() = default;
    // Of `count` values with these means and these sums of the second and third powers of the deviations.
    SkewMoments(std::uint64_t count, const std::array<double, Channels>& mean,
                const std::array<double, Channels>& squares, const std::array<double, Channels>& cubes)
        : count_(count), mean_(mean), squares_(squares), cubes_(cubes) {}

    void add(const std::array<double, Channels>& x) {
        double n = static_cast<double>(++count_), inv_n = 1 / n;
        for (int c = 0; c < Channels; ++c) {
            double delta = x[c] - mean_[c], step = delta * inv_n, term = delta * step * (n - 1);
            mean_[c] += step;
            cubes_[c] += step * (term * (n - 2) - 3 * squares_[c]);
            squares_[c] += term;
        }
    }
    void add(Vec3d x) requires(Channels == 3) { add(std::array<double, 3>{x.x, x.y, x.z}); }
    void merge(const SkewMoments& other) {
        if (other.count_ == 0) return;
        if (count_ == 0) {
            *this = other;
            return;
        }
        double na = static_cast<double>(count_), nb = static_cast<double>(other.count_), n = na + nb;
        for (int c = 0; c < Channels; ++c) {
            double delta = other.mean_[c] - mean_[c], d2 = delta * delta;
            cubes_[c] += other.cubes_[c] + d2 * delta * na * nb * (na - nb) / (n * n) +
                         3 * delta * (na * other.squares_[c] - nb * squares_[c]) / n;
            squares_[c] += other.squares_[c] + d2 * na * nb / n;
            mean_[c] += delta * nb / n;
        }
        count_ += other.count_;
    }

    std::uint64_t count() const { return count_; }
    // Zero while empty.
    double mean(int c = 0) const { return mean_[c]; }
    // Unbiased; infinite below two samples.
    double variance(int c = 0) const {
        if (count_ < 2) return std::numeric_limits<double>::infinity();
        return squares_[c] / static_cast<double>(count_ - 1);
    }
    double variance_of_mean(int c = 0) const {
        return count_ == 0 ? variance(c) : variance(c) / static_cast<double>(count_);
    }
    double standard_error(int c = 0) const { return std::sqrt(variance_of_mean(c)); }
    // Of one sample: the third central moment over the cube of the standard deviation; 0 without spread.
    double skewness(int c = 0) const {
        if (count_ < 3 || !(squares_[c] > 0)) return 0;
        double n = static_cast<double>(count_), m2 = squares_[c] / n;
        return cubes_[c] / n / (m2 * std::sqrt(m2));
    }
    // Of the mean: it falls with the square root of the number of samples.
    double skewness_of_mean(int c = 0) const {
        return count_ == 0 ? 0 : skewness(c) / std::sqrt(static_cast<double>(count_));
    }

  private:
    std::uint64_t count_ = 0;
    std::array<double, Channels> mean_{}, squares_{}, cubes_{};
};

// Johnson 1978, "Modified t Tests and Confidence Intervals for Asymmetrical Populations", JASA 73(363): z =
// (mean - truth) / standard error has the mean -g/2 when the mean's own skewness is g, because samples that
// are low also say that the spread is small. The corrected score is free of this to first order.
// The series holds for ordinary scores; beyond 3 its square term stays at its value there.
inline double skew_corrected_z(double z, double g) { return z + g / 6 + g * std::min(z * z, 9.0) / 3; }

} // namespace montelux
