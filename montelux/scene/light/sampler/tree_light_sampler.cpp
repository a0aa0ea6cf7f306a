#include "montelux/scene/light/sampler/tree_light_sampler.h"

#include <algorithm>
#include <array>
#include <limits>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/lane_functions.h"

namespace montelux {

namespace {

constexpr int node_width = LightTreeNode::width;
using Importances = Lanes<node_width>;

// In a fixed order, as all sums of importances.
float sum(Importances w) {
    float total = 0;
    for (int k = 0; k < node_width; ++k) total += w[k];
    return total;
}

bool usable(float total) { return total > 0 && total <= std::numeric_limits<float>::max(); }

// To choose among the node's groups: their intensities where no group has any importance, or the point is no number.
Importances choosable(const LightTreeNode& node, Importances w) {
    return usable(sum(w)) ? w : node.groups.intensity;
}
Importances importances(const LightTreeNode& node, const LitPoint& at) {
    return choosable(node, light_importance(node.groups, at));
}

struct Group {
    int k;
    float probability;
    double remapped;
};

Group choose(Importances w, double u) {
    const float total = sum(w);
    double left = u * double(total);
    int k = 0;
    for (int i = 0; i < node_width; ++i) {
        if (!(w[i] > 0)) continue;
        // The last one may take what rounding leaves.
        if (i > k && w[k] > 0) left -= double(w[k]);
        k = i;
        if (left < double(w[i])) break;
    }
    return {k, w[k] / total, std::clamp(left / double(w[k]), 0.0, largest_below_one<double>)};
}

// A product of many factors may be too small for a float; the sample exists all the same.
constexpr float least_probability = std::numeric_limits<float>::min();

} // namespace

TreeLightSampler::TreeLightSampler(LightParts parts, std::span<const double> powers,
                                   const BoundsOfRow& bounds, double scene_area)
    : parts_(std::move(parts)), place_of_row_(powers.size(), no_index) {
    std::vector<TreeLight> lights;
    std::vector<double> infinite_powers;
    for (Index row = 0; row < powers.size(); ++row) {
        if (!(powers[row] > 0)) continue;
        if (const auto b = bounds(row)) {
            lights.push_back({*b, powers[row]});
            row_of_light_.push_back(row);
        } else {
            infinite_powers.push_back(powers[row]);
            infinite_rows_.push_back(row);
        }
    }
    if (!lights.empty()) {
        tree_.emplace(lights);
        first_infinite_ = static_cast<Index>(tree_->nodes().size() * node_width);
        for (Index i = 0; i < lights.size(); ++i) place_of_row_[row_of_light_[i]] = tree_->place_of(i);
    }
    if (infinite_powers.empty()) return;
    infinite_.emplace(infinite_powers);
    for (Index i = 0; i < infinite_powers.size(); ++i) place_of_row_[infinite_rows_[i]] = first_infinite_ + i;
    if (tree_) infinite_importance_ = infinite_->weight_sum() / scene_area / tree_->irradiance_scale();
}

float TreeLightSampler::infinite_share(Importances root) const {
    if (!infinite_) return 0;
    constexpr double least = 1.0 / 16;
    const double share = infinite_importance_ / (infinite_importance_ + double(sum(root)));
    return static_cast<float>(share > least ? std::min(share, 1 - least) : least);
}

LightChoice TreeLightSampler::choice(Index row, float probability, double remapped) const {
    LightChoice choice = parts_.at(row);
    choice.probability = std::max(probability, least_probability);
    choice.remapped = remapped;
    return choice;
}

LightChoice TreeLightSampler::sample(const ReferencePoint& from, double u) const {
    float probability = 1;
    if (!tree_) {
        const auto chosen = infinite_->sample(u);
        return choice(infinite_rows_[chosen.index], static_cast<float>(chosen.probability), chosen.remapped);
    }
    const LitPoint at = tree_->lit_point(from);
    const std::span<const LightTreeNode> nodes = tree_->nodes();
    Importances w = light_importance(nodes[0].groups, at);
    if (infinite_) {
        const float share = infinite_share(w);
        if (u < double(share)) {
            const auto chosen = infinite_->sample(std::min(u / double(share), largest_below_one<double>));
            return choice(infinite_rows_[chosen.index], share * static_cast<float>(chosen.probability),
                          chosen.remapped);
        }
        u = std::min((u - double(share)) / (1 - double(share)), largest_below_one<double>);
        probability = 1 - share;
    }
    w = choosable(nodes[0], w);
    for (Index node = 0;;) {
        const Group group = choose(w, u);
        probability *= group.probability;
        u = group.remapped;
        const auto k = static_cast<std::size_t>(group.k);
        const Index below = nodes[node].below[k];
        if (nodes[node].leads_to_light(group.k)) return choice(row_of_light_[below], probability, u);
        node = below;
        w = importances(nodes[node], at);
    }
}

float TreeLightSampler::probability(const ReferencePoint& from, Index light, Index part) const {
    const Index place = place_of_row_[parts_.row(light, part)];
    if (place == no_index) return 0;
    if (!tree_) return std::max(infinite_->probability(place - first_infinite_), least_probability);
    const LitPoint at = tree_->lit_point(from);
    const std::span<const LightTreeNode> nodes = tree_->nodes();
    float probability = 1;
    Importances w = light_importance(nodes[0].groups, at);
    if (infinite_) {
        const float share = infinite_share(w);
        if (place >= first_infinite_)
            return std::max(share * infinite_->probability(place - first_infinite_), least_probability);
        probability = 1 - share;
    }
    w = choosable(nodes[0], w);
    // The places that lead to the light, from below; multiplied in the order of `sample`.
    std::array<Index, LightTree::max_depth> path;
    std::size_t length = 0;
    for (Index p = place; p != no_index; p = nodes[p / node_width].parent) path[length++] = p;
    for (std::size_t i = length; i-- > 0;) {
        if (i + 1 < length) w = importances(nodes[path[i] / node_width], at);
        const float own = w[static_cast<int>(path[i] % node_width)];
        if (!(own > 0)) return 0;
        probability *= own / sum(w);
    }
    return std::max(probability, least_probability);
}

} // namespace montelux
