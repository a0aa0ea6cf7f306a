// Running mean and variance in one pass, mergeable in any grouping: the accumulator of every estimate.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "montelux/mc/math/vec.h"

namespace montelux {

// Moments of `Channels` quantities that are sampled together (one count for all).
// Welford 1962, "Note on a Method for Calculating Corrected Sums of Squares and Products"; merging by
// Chan, Golub and LeVeque 1983, "Algorithms for Computing the Sample Variance". Neither loses digits
// when the mean is large beside the deviation. Values must be finite: screen them before `add`.
template <int Channels, typename Real = double>
class ChannelMoments {
  public:
    using Values = std::array<Real, Channels>;

    constexpr ChannelMoments() = default;
    // The accumulator with this state, as read from a checkpoint.
    constexpr ChannelMoments(std::uint64_t count, const Values& mean, const Values& squared_deviations)
        : count_(count), mean_(mean), squares_(squared_deviations) {}

    constexpr void add(const Values& x) {
        ++count_;
        Real inv_n = Real(1) / static_cast<Real>(count_);
        for (int c = 0; c < Channels; ++c) {
            Real delta = x[c] - mean_[c];
            mean_[c] += delta * inv_n;
            squares_[c] += delta * (x[c] - mean_[c]);
        }
    }
    template <typename T>
    requires(Channels == 3) constexpr void add(Vec3<T> x) {
        add(Values{static_cast<Real>(x.x), static_cast<Real>(x.y), static_cast<Real>(x.z)});
    }
    constexpr void merge(const ChannelMoments& other) {
        if (other.count_ == 0) return;
        if (count_ == 0) {
            *this = other;
            return;
        }
        Real na = static_cast<Real>(count_), nb = static_cast<Real>(other.count_);
        Real share = nb / (na + nb);
        for (int c = 0; c < Channels; ++c) {
            Real delta = other.mean_[c] - mean_[c];
            mean_[c] += delta * share;
            squares_[c] += other.squares_[c] + delta * delta * (na * share);
        }
        count_ += other.count_;
    }

    constexpr std::uint64_t count() const { return count_; }
    // Zero while empty.
    constexpr Real mean(int c = 0) const { return mean_[c]; }
    constexpr const Values& means() const { return mean_; }
    constexpr const Values& squared_deviations() const { return squares_; }
    // Unbiased variance of one sample; infinite below two samples, which say nothing about it.
    constexpr Real variance(int c = 0) const {
        if (count_ < 2) return std::numeric_limits<Real>::infinity();
        return squares_[c] / static_cast<Real>(count_ - 1);
    }
    Real standard_deviation(int c = 0) const { return std::sqrt(variance(c)); }
    // Unbiased variance of the mean, sigma^2 / N.
    constexpr Real variance_of_mean(int c = 0) const {
        return count_ == 0 ? variance(c) : variance(c) / static_cast<Real>(count_);
    }
    // Standard error of the mean, sigma / sqrt(N); infinite below two samples.
    Real standard_error(int c = 0) const { return std::sqrt(variance_of_mean(c)); }

    constexpr bool operator==(const ChannelMoments&) const = default;

  private:
    std::uint64_t count_ = 0;
    Values mean_{}, squares_{};
};

class RunningMoments : public ChannelMoments<1, double> {
  public:
    using ChannelMoments::ChannelMoments;
    constexpr RunningMoments() = default;
    constexpr RunningMoments(std::uint64_t count, double mean, double squared_deviations)
        : ChannelMoments(count, Values{mean}, Values{squared_deviations}) {}

    constexpr void add(double x) { ChannelMoments::add(Values{x}); }
    double sum() const { return static_cast<double>(count()) * mean(); }
};

// Three channels of a pixel in 56 bytes.
using Moments3 = ChannelMoments<3, double>;

} // namespace montelux
