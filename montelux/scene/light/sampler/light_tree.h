// LightTree: groups of lights within groups, for choosing one by its importance for a point.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/math/lanes.h"
#include "montelux/mc/math/vector_bytes.h"
#include "montelux/scene/index.h"
#include "montelux/scene/light/light_model.h"
#include "montelux/scene/light/sampler/light_importance.h"

namespace montelux {

// A light of the tree.
struct TreeLight {
    LightBounds bounds;
    double power = 0; // above 0, finite
};

// Up to `width` groups, whose importances are computed in lanes. A group is a single light or a node.
struct LightTreeNode {
    static constexpr int width = 8;
    LightGroup<Lanes<width>> groups;
    std::array<Index, width> below; // the light or node of each group
    std::uint32_t is_light = 0;     // bits
    Index parent = no_index;        // place of its group

    bool leads_to_light(int k) const { return (is_light >> k & 1) != 0; }
};

// The place of a group is node * width + its lane. At most max_depth nodes lead to a light.
class LightTree {
  public:
    static constexpr int max_depth = 64;

    // At least one light. Throws Error for more than 2^28.
    explicit LightTree(std::span<const TreeLight> lights);

    // The first is the root.
    std::span<const LightTreeNode> nodes() const { return nodes_; }
    Index place_of(Index light) const { return places_[light]; }
    LitPoint lit_point(const ReferencePoint& from) const {
        return {(from.p - origin_) * inverse_unit_, from.facing};
    }
    // Sum of the intensities of all lights over the squared unit of length: of this the importances are shares.
    double irradiance_scale() const { return irradiance_scale_; }

    std::size_t bytes() const { return vector_bytes(nodes_, places_); }

  private:
    std::vector<LightTreeNode> nodes_;
    std::vector<Index> places_; // of each light
    Point3f origin_;
    float inverse_unit_ = 1;
    double irradiance_scale_ = 1;
};

} // namespace montelux
