#include "montelux/transport/guiding/guiding_field.h"

#include <cmath>
#include <limits>
#include <span>

#include "montelux/mc/math/error.h"

namespace montelux {

std::size_t GuidingField::bytes() const {
    std::size_t bytes = expected_.size() * sizeof(float) + regions_.size() * sizeof(GuidingRegion);
    for (const std::vector<Node>& nodes : trees_) bytes += nodes.size() * sizeof(Node);
    for (const GuidingRegion& region : regions_) bytes += region.directions.bytes();
    return bytes;
}

std::vector<GuidingField::Cell> GuidingField::cells() const {
    constexpr float all = std::numeric_limits<float>::infinity();
    std::vector<Cell> cells;
    for (std::size_t facing = 0; facing < facings; ++facing) {
        const std::vector<Node>& nodes = trees_[facing];
        if (nodes.empty()) continue;
        // Children follow their parents.
        std::vector<Cell> of_node(nodes.size());
        of_node[0] = {static_cast<Facing>(facing), {-all, -all, -all}, {all, all, all}};
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            const Node& node = nodes[n];
            if (node.axis == 3) {
                cells.push_back(of_node[n]);
                continue;
            }
            of_node[node.low] = of_node[node.high] = of_node[n];
            of_node[node.low].high[static_cast<int>(node.axis)] = node.split;
            of_node[node.high].low[static_cast<int>(node.axis)] = node.split;
        }
    }
    return cells;
}

void GuidingField::save(ByteWriter& out) const {
    for (const std::vector<Node>& nodes : trees_) {
        out.put(static_cast<std::uint64_t>(nodes.size()));
        out.put_all(std::span<const Node>(nodes));
    }
    out.put(static_cast<std::uint64_t>(regions_.size()));
    for (const GuidingRegion& region : regions_) {
        out.put(region.sphere);
        region.directions.save(out);
        out.put(region.share);
        out.put(region.radiance);
        out.put(region.visible);
    }
    out.put(bounds_);
    out.put(static_cast<std::uint64_t>(expected_.size()));
    out.put_all(std::span<const float>(expected_));
}

GuidingField GuidingField::load(ByteReader& in) {
    GuidingField field;
    const auto damaged = [](bool is) {
        if (is) throw Error("guiding", "the saved guide is damaged");
    };
    for (std::vector<Node>& nodes : field.trees_) {
        const auto count = in.get<std::uint64_t>();
        damaged(count > in.remaining() / sizeof(Node));
        nodes.resize(count);
        in.get_all(std::span<Node>(nodes));
    }
    const auto regions = in.get<std::uint64_t>();
    damaged(regions > in.remaining());
    for (std::uint64_t i = 0; i < regions; ++i) {
        GuidingRegion& region = field.regions_.emplace_back();
        region.sphere = in.get<ParallaxSphere>();
        region.directions = QuadtreeDensity::load(in);
        const ParallaxSphere& s = region.sphere;
        damaged(!(s.radius >= 0 && std::isfinite(s.radius + s.centre.x + s.centre.y + s.centre.z)));
        region.share = in.get<float>();
        region.radiance = in.get<float>();
        region.visible = in.get<float>();
        damaged(!(region.share >= 0 && region.share < 1 && region.visible > 0 && region.visible <= 1));
    }
    for (const std::vector<Node>& nodes : field.trees_)
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            const Node& node = nodes[n];
            damaged(node.axis > 3 || (node.axis == 3 && node.low >= regions) ||
                    (node.axis < 3 && (node.low <= n || node.high <= n || node.low >= nodes.size() ||
                                       node.high >= nodes.size())));
        }
    field.bounds_ = in.get<PixelBounds>();
    for (const int edge : {field.bounds_.x0, field.bounds_.y0, field.bounds_.x1, field.bounds_.y1})
        damaged(edge < 0 || edge > 1 << 24);
    const auto pixels = in.get<std::uint64_t>();
    const std::uint64_t held = std::uint64_t(std::max(field.bounds_.width(), 0)) *
                               std::uint64_t(std::max(field.bounds_.height(), 0));
    damaged((pixels != 0 && pixels != held) || pixels > in.remaining() / sizeof(float));
    field.expected_.resize(pixels);
    in.get_all(std::span<float>(field.expected_));
    return field;
}

} // namespace montelux
