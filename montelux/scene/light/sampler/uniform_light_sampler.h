// Choice of lights with equal probabilities.
#pragma once

#include <algorithm>

#include "montelux/mc/dist/discrete.h"
#include "montelux/scene/light/sampler/light_parts.h"

namespace montelux {

class UniformLightSampler {
  public:
    UniformLightSampler() = default;
    explicit UniformLightSampler(LightParts parts) : parts_(std::move(parts)) {}

    Index size() const { return parts_.size(); }
    LightChoice sample(const ReferencePoint&, double u) const {
        const double scaled = u * size();
        const Index row = std::min(static_cast<Index>(scaled), size() - 1);
        LightChoice choice = parts_.at(row);
        choice.probability = 1 / static_cast<float>(size());
        choice.remapped = std::min(scaled - row, largest_below_one<double>);
        return choice;
    }
    float probability(const ReferencePoint&, Index, Index) const { return 1 / static_cast<float>(size()); }

    std::size_t bytes() const { return parts_.bytes(); }

  private:
    LightParts parts_;
};

} // namespace montelux
