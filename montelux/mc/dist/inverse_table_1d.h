// A density on an interval in pieces of equal probability: sampled by one table lookup.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <vector>

#include "montelux/mc/dist/piecewise_1d.h"

namespace montelux {

// Approximates a density by one that is constant on `pieces` pieces of probability 1/pieces each. The density
// that is reported is the one that is sampled, so weights f / pdf stay exact; the pieces only decide how even
// they are. For densities that are drawn from in every sample; PiecewiseLinear1D draws from the density
// itself.
class InverseTable1D {
  public:
    explicit InverseTable1D(const PiecewiseLinear1D& density, std::size_t pieces = 512) {
        edges_.reserve(pieces + 1);
        edges_.push_back(static_cast<float>(density.lower()));
        for (std::size_t i = 1; i < pieces; ++i)
            edges_.push_back(std::max(
                edges_.back(),
                static_cast<float>(density.sample(static_cast<double>(i) / static_cast<double>(pieces)).x)));
        edges_.push_back(static_cast<float>(density.upper()));
    }

    float lower() const { return edges_.front(); }
    float upper() const { return edges_.back(); }
    std::size_t size() const { return edges_.size() - 1; }

    struct Sample {
        float x = 0;
        float inverse_pdf = 0; // in units of x
    };
    // u in [0, 1).
    Sample sample(float u) const {
        float scaled = u * static_cast<float>(size());
        std::size_t i = std::min(static_cast<std::size_t>(scaled), size() - 1);
        float width = edges_[i + 1] - edges_[i];
        return {edges_[i] + (scaled - static_cast<float>(i)) * width, width * static_cast<float>(size())};
    }
    // Zero outside [lower, upper).
    float pdf(float x) const {
        if (!(x >= lower() && x < upper())) return 0;
        auto next = std::upper_bound(edges_.begin(), edges_.end(), x);
        return 1 / ((*next - *(next - 1)) * static_cast<float>(size()));
    }

  private:
    std::vector<float> edges_;
};

} // namespace montelux
