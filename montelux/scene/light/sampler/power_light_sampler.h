// Choice of lights in proportion to their power.
#pragma once

#include <optional>
#include <span>

#include "montelux/mc/dist/alias_table.h"
#include "montelux/scene/light/sampler/light_parts.h"

namespace montelux {

// Parts of power 0 are never chosen, unless all are: then all have the same probability.
class PowerLightSampler {
  public:
    // `powers` are those of LightModel::powers, one per part, finite and not negative.
    PowerLightSampler(LightParts parts, std::span<const double> powers) : parts_(std::move(parts)) {
        if (!powers.empty()) table_.emplace(powers);
    }

    Index size() const { return parts_.size(); }
    [[gnu::always_inline]] LightChoice sample(const ReferencePoint&, double u) const {
        const auto chosen = table_->sample(u);
        LightChoice choice = parts_.at(chosen.index);
        choice.probability = static_cast<float>(chosen.probability);
        choice.remapped = chosen.remapped;
        return choice;
    }
    float probability(const ReferencePoint&, Index light, Index part) const {
        return table_->probability(parts_.row(light, part));
    }

    std::size_t bytes() const { return parts_.bytes() + (table_ ? table_->bytes() : 0); }

  private:
    LightParts parts_;
    std::optional<AliasTable> table_;
};

} // namespace montelux
