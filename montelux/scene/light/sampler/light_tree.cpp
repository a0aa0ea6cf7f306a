#include "montelux/scene/light/sampler/light_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "montelux/mc/math/error.h"
#include "montelux/mc/math/lane_functions.h"
#include "montelux/mc/math/vec_lanes.h"
#include "montelux/scene/light/sampler/light_cone.h"
#include "montelux/scene/light/sampler/light_split.h"

namespace montelux {

namespace {

// Importances stay within the range of a float even where intensities do not.
constexpr double least_intensity_share = 1e-20;
// Spheres grow by more than the rounding of positions in units of the tree.
constexpr float rounding = 0x1p-21f;

struct Range {
    Index begin, end;
    double cost;

    Index size() const { return end - begin; }
};

class Builder {
  public:
    Builder(std::span<SplitLight> lights, std::vector<LightTreeNode>& nodes, std::vector<Index>& places)
        : lights_(lights), nodes_(nodes), places_(places) {}

    // The node of the lights [begin, end); returns the cone of all.
    LightCone build(Index begin, Index end, Index parent, int depth) {
        std::array<Range, LightTreeNode::width> ranges;
        std::size_t count = 1;
        ranges[0] = {begin, end, 1};
        while (count < ranges.size()) {
            // The most expensive range that can be split.
            Range* widest = nullptr;
            for (Range& r : std::span(ranges).first(count))
                if (r.size() > 1 && (widest == nullptr || r.cost > widest->cost)) widest = &r;
            if (widest == nullptr) break;
            const Range whole = *widest;
            const LightSplit split =
                split_lights(lights_.subspan(whole.begin, whole.size()), must_halve(whole.size(), depth));
            const Index middle = whole.begin + split.first_count;
            *widest = {whole.begin, middle, split.first_cost};
            ranges[count++] = {middle, whole.end, split.second_cost};
        }

        const auto index = static_cast<Index>(nodes_.size());
        nodes_.emplace_back().parent = parent;
        std::optional<LightCone> all;
        for (std::size_t k = 0; k < count; ++k) {
            const Range& r = ranges[k];
            const Index place = index * LightTreeNode::width + static_cast<Index>(k);
            const bool single = r.size() == 1;
            const auto below = single ? lights_[r.begin].light : static_cast<Index>(nodes_.size());
            const LightCone cone = single ? lights_[r.begin].cone : build(r.begin, r.end, place, depth + 1);
            if (single) places_[below] = place;
            LightTreeNode& node = nodes_[index];
            node.below[k] = below;
            if (single) node.is_light |= 1u << k;
            set_group(node, static_cast<int>(k), r, cone);
            if (all)
                all->add(cone);
            else
                all = cone;
        }
        return *all;
    }

  private:
    // Halves from here on, or the tree may become too deep: a node takes off at least one binary level.
    static bool must_halve(Index size, int depth) {
        return depth + static_cast<int>(std::bit_width(size)) + 1 >= LightTree::max_depth;
    }

    void set_group(LightTreeNode& node, int k, const Range& range, const LightCone& cone) const {
        const auto lights = lights_.subspan(range.begin, range.size());
        SplitBox box;
        double intensity = 0;
        for (const SplitLight& light : lights) {
            box.add(light.lower, light.upper);
            intensity += double(light.intensity);
        }
        const Vec3f center = box.center();
        float r2 = 0;
        for (const SplitLight& light : lights)
            r2 = std::max(r2, length_squared(max(light.upper - center, center - light.lower)));
        auto& g = node.groups;
        set_lane(g.center, k, center);
        g.radius.set(k, std::sqrt(r2) * (1 + rounding) + rounding);
        set_lane(g.axis, k, cone.axis);
        g.cos_theta_o.set(k, cone.cos_theta_o);
        g.sin_theta_o.set(k, std::sqrt(std::max(0.0f, 1 - cone.cos_theta_o * cone.cos_theta_o)));
        g.cos_theta_e.set(k, cone.cos_theta_e);
        g.two_sided.set(k, cone.two_sided ? 1 : 0);
        g.intensity.set(k, static_cast<float>(intensity));
    }

    std::span<SplitLight> lights_;
    std::vector<LightTreeNode>& nodes_;
    std::vector<Index>& places_;
};

} // namespace

LightTree::LightTree(std::span<const TreeLight> lights) : places_(lights.size()) {
    if (lights.size() > (1u << 28)) throw Error("lights", "more than 2^28 lights in a tree");
    Bounds3 box;
    for (const TreeLight& light : lights) {
        box.add(light.bounds.box.lower);
        box.add(light.bounds.box.upper);
    }
    origin_ = Vec3f(box.center());
    const double offset =
        std::max({std::abs(box.center().x), std::abs(box.center().y), std::abs(box.center().z)});
    const double unit = std::max({box.radius(), 1e-6 * offset, 1e-9});
    inverse_unit_ = static_cast<float>(1 / unit);

    std::vector<SplitLight> split;
    split.reserve(lights.size());
    std::vector<double> intensities;
    intensities.reserve(lights.size());
    double sum = 0;
    for (const TreeLight& light : lights) {
        const LightCone cone(light.bounds);
        const double measure = cone.measure();
        intensities.push_back(measure > 0 ? light.power / measure : light.power);
        sum += intensities.back();
    }
    irradiance_scale_ = sum / (unit * unit);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const LightBounds& b = lights[i].bounds;
        const auto in_units = [&](Vec3d p) { return Vec3f((p - Vec3d(origin_)) * (1 / unit)); };
        split.push_back(
            {.lower = in_units(b.box.lower),
             .upper = in_units(b.box.upper),
             .cone = LightCone(b),
             .intensity = static_cast<float>(std::max(intensities[i] / sum, least_intensity_share)),
             .light = static_cast<Index>(i)});
    }
    nodes_.reserve(lights.size() / 3 + 1);
    Builder(split, nodes_, places_).build(0, static_cast<Index>(split.size()), no_index, 0);
    nodes_.shrink_to_fit();
}

} // namespace montelux
