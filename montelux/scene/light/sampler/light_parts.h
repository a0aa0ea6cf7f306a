// LightParts: the parts of all lights in one sequence.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "montelux/mc/math/vector_bytes.h"
#include "montelux/scene/light/light_model.h"

namespace montelux {

// A part of a light, chosen at random.
struct LightChoice {
    Index light = no_index;
    Index part = 0;
    float probability = 0;
    double remapped = 0; // a fresh uniform number in [0, 1), of fewer bits than the argument
};

class LightParts {
  public:
    LightParts() = default;
    // For lights with these numbers of parts. Throws Error for 2^32 - 1 parts and more.
    explicit LightParts(std::span<const Index> counts);

    Index size() const { return first_.back(); }
    Index row(Index light, Index part) const { return first_[light] + part; }
    // Only `light` and `part` are set.
    [[gnu::always_inline]] LightChoice at(Index row) const {
        if (single_) return {.light = row};
        // One light has them all, or they are searched.
        const auto after =
            first_.size() == 2 ? first_.end() - 1 : std::upper_bound(first_.begin(), first_.end(), row);
        const auto light = static_cast<Index>(after - first_.begin() - 1);
        return {.light = light, .part = row - first_[light]};
    }

    std::size_t bytes() const { return vector_bytes(first_); }

  private:
    std::vector<Index> first_{0}; // of each light, and the number of all
    bool single_ = true;          // each light has one
};

} // namespace montelux
