// Choice of lights by their importance for the point that is lit, in a tree of lights.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "montelux/mc/dist/alias_table.h"
#include "montelux/scene/light/sampler/light_parts.h"
#include "montelux/scene/light/sampler/light_tree.h"

namespace montelux {

// After Conty Estevez and Kulla 2018. Parts of power 0 are never chosen. A part with bounds has a probability
// of 0 only for points that it cannot illuminate. Parts without bounds, of infinite lights, are chosen by
// their power, beside the tree.
class TreeLightSampler {
  public:
    // LightModel::bounds of the part at a row of LightParts.
    using BoundsOfRow = std::function<std::optional<LightBounds>(Index row)>;

    // One power per part, finite and not negative, at least one above 0. `scene_area`: of the disk through which
    // light from infinity enters the scene.
    TreeLightSampler(LightParts parts, std::span<const double> powers, const BoundsOfRow& bounds,
                     double scene_area);

    Index size() const { return parts_.size(); }
    LightChoice sample(const ReferencePoint& from, double u) const;
    float probability(const ReferencePoint& from, Index light, Index part) const;

    std::size_t bytes() const {
        return parts_.bytes() + (tree_ ? tree_->bytes() : 0) + (infinite_ ? infinite_->bytes() : 0) +
               vector_bytes(row_of_light_, place_of_row_, infinite_rows_);
    }

  private:
    using Importances = Lanes<LightTreeNode::width>;

    float infinite_share(Importances root) const;
    LightChoice choice(Index row, float probability, double remapped) const;

    LightParts parts_;
    std::optional<LightTree> tree_;
    std::vector<Index> row_of_light_; // of the tree
    std::vector<Index> place_of_row_; // in the tree; or in `infinite_`, from first_infinite_ on; or no_index
    Index first_infinite_ = 0;
    std::vector<Index> infinite_rows_;
    std::optional<AliasTable> infinite_; // by power
    double infinite_importance_ = 0;     // of all, as LightTree's
};

} // namespace montelux
