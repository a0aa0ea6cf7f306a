// A discrete random variable drawn by inversion of its cumulative sum: by walking it, or by bisection.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "montelux/mc/dist/search.h"
#include "montelux/mc/math/constants.h"

namespace montelux {

// An index, its probability, and where in the index's share of [0, 1) the uniform number fell: a fresh
// uniform number in [0, 1), with as many bits fewer as the index used up.
template <std::floating_point T = float>
struct DiscreteSample {
    std::uint32_t index = 0;
    T probability = 0;
    T remapped = 0;
};

template <std::floating_point T>
constexpr T largest_below_one = T(1) - std::numeric_limits<T>::epsilon() / 2;

// Probabilities proportional to the weights. An index of weight zero is never drawn. Weights that are all
// zero give the uniform distribution (weight_sum() is then 0), so that a table of a light that happens to
// be black can still be sampled. Throws Error on an empty table and on negative or non-finite weights.
class DiscreteDistribution {
  public:
    explicit DiscreteDistribution(std::span<const double> weights);

    std::size_t size() const { return cdf_.size() - 1; }
    double weight_sum() const { return weight_sum_; }
    double probability(std::size_t i) const { return cdf_[i + 1] - cdf_[i]; }
    // Probability of all indices up to and including i; the last is exactly 1.
    double cdf(std::size_t i) const { return cdf_[i + 1]; }

    // Inversion by bisection, O(log n).
    template <std::floating_point T>
    DiscreteSample<T> sample(T u) const {
        double v = static_cast<double>(u);
        return make_sample<T>(v, find_last_not_above(cdf_.data(), size(), v));
    }
    // Inversion by walking the sum from its start, O(n); best where the first few indices hold most of
    // the probability. Draws exactly what `sample` draws.
    template <std::floating_point T>
    DiscreteSample<T> sample_by_walking(T u) const {
        double v = static_cast<double>(u);
        std::size_t i = 0;
        while (i + 1 < size() && cdf_[i + 1] <= v) ++i;
        return make_sample<T>(v, i);
    }

  private:
    template <std::floating_point T>
    DiscreteSample<T> make_sample(double v, std::size_t i) const {
        // Only reached when v >= 1, outside the contract: step back from weightless indices at the end.
        while (i > 0 && cdf_[i] == cdf_[i + 1]) --i;
        double p = cdf_[i + 1] - cdf_[i];
        T remapped = std::clamp(static_cast<T>((v - cdf_[i]) / p), T(0), largest_below_one<T>);
        return {static_cast<std::uint32_t>(i), static_cast<T>(p), remapped};
    }

    std::vector<double> cdf_; // cdf_[i] is the probability of the indices below i
    double weight_sum_ = 0;
};

} // namespace montelux
