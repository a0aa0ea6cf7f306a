#include "montelux/mc/dist/quadtree_density.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/error.h"

namespace montelux {

struct QuadtreeDensity::Builder {
    const QuadtreeSettings& settings;
    std::vector<Node>& nodes;
    double least; // mass of a square that is split

    struct Sums {
        double mean = 0, square = 0; // of value / pdf, value^2 / pdf
    };
    static Sums sums_of(std::span<const SquareSample> samples) {
        Sums sums;
        for (const SquareSample& s : samples) {
            const double mean = double(s.value) / double(s.pdf);
            sums.mean += mean;
            sums.square += mean * double(s.value);
        }
        return sums;
    }

    // Fills nodes[n], whose square has corner and width, and an integral of value^2 / pdf of `square`, estimated also
    // from the squares that contain it. Returns its mass, up to a factor.
    double fill(std::size_t n, std::span<SquareSample> samples, double square, Vec2f corner, float width,
                int depth) {
        const float half = 0.5f * width;
        const Vec2f middle{corner.x + half, corner.y + half};
        // Rows, then columns: quadrants are x + 2 y.
        const auto begin = samples.begin(), end = samples.end();
        const auto row =
            std::stable_partition(begin, end, [&](const SquareSample& s) { return s.p.y < middle.y; });
        const auto in_left = [&](const SquareSample& s) { return s.p.x < middle.x; };
        const auto low = std::stable_partition(begin, row, in_left),
                   high = std::stable_partition(row, end, in_left);
        const std::array<std::span<SquareSample>, 4> parts{std::span(begin, low), std::span(low, row),
                                                           std::span(row, high), std::span(high, end)};
        std::array<Sums, 4> sums;
        double squares = 0;
        for (unsigned q = 0; q < 4; ++q) {
            sums[q] = sums_of(parts[q]);
            squares += sums[q].square;
        }
        const double count = static_cast<double>(samples.size());
        const double trust = count / (count + double(settings.prior_samples));
        std::array<double, 4> mass{};
        double total = 0;
        for (unsigned q = 0; q < 4; ++q) {
            const double own = square * (trust * sums[q].square / squares + (1 - trust) * 0.25);
            const bool splits = sums[q].mean > least && parts[q].size() >= settings.split_samples &&
                                depth < settings.max_depth && nodes.size() < settings.max_nodes;
            if (splits) {
                const std::size_t child = nodes.size();
                nodes.emplace_back();
                nodes[n].child[q] = static_cast<std::uint16_t>(child);
                const Vec2f at{q % 2 == 0 ? corner.x : middle.x, q < 2 ? corner.y : middle.y};
                mass[q] = fill(child, parts[q], own, at, half, depth + 1);
            } else {
                mass[q] = std::sqrt(own) * double(half); // the root of the area
            }
            total += mass[q];
        }
        for (unsigned q = 0; q < 4; ++q) nodes[n].share[q] = static_cast<float>(mass[q] / total);
        return total;
    }
};

QuadtreeDensity::QuadtreeDensity(std::span<SquareSample> samples, const QuadtreeSettings& settings) {
    const Builder::Sums sums = Builder::sums_of(samples);
    const double mass = sums.mean;
    if (!(mass > 0 && sums.square > 0) || !std::isfinite(mass) || !std::isfinite(sums.square)) return;
    nodes_.emplace_back();
    Builder builder{settings, nodes_, double(settings.split_share) * mass};
    const double root = builder.fill(0, samples, sums.square, {0, 0}, 1, 1);
    second_moment_ = root * root;
}

void QuadtreeDensity::save(ByteWriter& out) const {
    out.put(static_cast<std::uint64_t>(nodes_.size()));
    out.put_all(std::span<const Node>(nodes_));
}

QuadtreeDensity QuadtreeDensity::load(ByteReader& in) {
    QuadtreeDensity density;
    const auto count = in.get<std::uint64_t>();
    if (count > 0x10000 || count > in.remaining() / sizeof(Node))
        throw Error("density", "the saved density has more nodes than there can be");
    density.nodes_.resize(count);
    in.get_all(std::span<Node>(density.nodes_));
    for (std::size_t n = 0; n < count; ++n) {
        float sum = 0;
        for (unsigned q = 0; q < 4; ++q) {
            const Node& node = density.nodes_[n];
            sum += node.share[q];
            if (!(node.share[q] >= 0) || node.child[q] >= count || (node.child[q] != 0 && node.child[q] <= n))
                throw Error("density", "the saved density is damaged");
        }
        if (!(std::abs(sum - 1) < 1e-3f)) throw Error("density", "the saved density is damaged");
    }
    return density;
}

} // namespace montelux
