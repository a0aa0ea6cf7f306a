// A discrete random variable drawn in constant time by an alias table.
#pragma once

#include <concepts>
#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/dist/discrete.h"

namespace montelux {

// Walker 1974; built in O(n) as in Vose 1991, "A Linear Algorithm for Generating Random Numbers with a
// Given Distribution". Weights as for DiscreteDistribution: zero weights are never drawn, all-zero
// weights are uniform, bad ones throw Error. A float uniform number has 24 bits: among more than some 2^14
// entries, or where a probability is below some 2^-14, draw with a double (SampleStream::refined), or the
// steps of u show in the probabilities.
class AliasTable {
  public:
    explicit AliasTable(std::span<const float> weights);
    explicit AliasTable(std::span<const double> weights);

    std::size_t size() const { return bins_.size(); }
    double weight_sum() const { return weight_sum_; }
    float probability(std::size_t i) const { return bins_[i].probability; }

    template <std::floating_point T>
    DiscreteSample<T> sample(T u) const {
        T scaled = u * static_cast<T>(bins_.size());
        std::size_t i = std::min(static_cast<std::size_t>(scaled), bins_.size() - 1);
        const Bin& bin = bins_[i];
        T within = std::min(scaled - static_cast<T>(i), largest_below_one<T>);
        T threshold = static_cast<T>(bin.threshold);
        if (within < threshold)
            return {static_cast<std::uint32_t>(i), static_cast<T>(bin.probability),
                    std::min(within / threshold, largest_below_one<T>)};
        return {bin.alias, static_cast<T>(bins_[bin.alias].probability),
                std::min((within - threshold) / (1 - threshold), largest_below_one<T>)};
    }

    std::size_t bytes() const { return bins_.size() * sizeof(Bin); }

  private:
    struct Bin {
        // Share of the bin that returns its own index. A double: an index that many bins return has the
        // sum of their rests, each of them the small difference from 1.
        double threshold;
        float probability;   // of its own index
        std::uint32_t alias; // the index that the rest of the bin returns
    };
    template <typename T>
    void build(std::span<const T> weights);

    std::vector<Bin> bins_;
    double weight_sum_ = 0;
};

} // namespace montelux
