// QuadtreeDensity: a piecewise constant density on the unit square, fine where its mass is.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/io/byte_stream.h"
#include "montelux/mc/math/vec.h"

namespace montelux {

// A sample of a function on the unit square, drawn with a density: what a QuadtreeDensity learns from.
struct SquareSample {
    Vec2f p;
    float value = 0; // of the function, or an unbiased estimate of it; at least 0
    float pdf = 0;   // per unit area; greater than 0
};

struct QuadtreeSettings {
    float split_share = 0.01f;        // a square with more of the mass is split
    std::uint32_t split_samples = 16; // and one with fewer samples is not
    // A square's quadrants count as even with the weight of so many samples: those without a sample may have been missed
    // by chance.
    float prior_samples = 2;
    int max_depth = 12;
    std::uint32_t max_nodes = 2048;
};

// Squares are split into four until none holds much of the mass (Mueller, Gross, Novak 2017, "Practical Path
// Guiding for Efficient Light-Transport Simulation"). Greater than zero
// everywhere.
class QuadtreeDensity {
  public:
    // Density and point of a sample.
    struct Sample {
        Vec2f p;
        float pdf = 0; // per unit area
    };

    // Uniform.
    QuadtreeDensity() = default;
    // Learned from samples, which may be reordered. The density that is least noisy for the estimator value / pdf
    // under it is proportional to the root of the mean square of the value, of the function's noise too (Rath et al.
    // 2020, "Variance-Aware Path Guiding", section 4). Uniform if no value is above 0.
    QuadtreeDensity(std::span<SquareSample> samples, const QuadtreeSettings& settings);
    // The sum over the samples that it was learned from of value^2 / pdf over this density, but for `prior_samples`: in
    // proportion to the second moment of the estimator value / density. 0 without samples, and after load().
    double second_moment() const { return second_moment_; }

    // u is uniform in [0, 1)^2; strata of u stay connected.
    Sample sample(Vec2f u) const {
        Sample s{{0, 0}, 1};
        float width = 1;
        for (const Node* at = root(); at != nullptr;) {
            const Node& node = *at;
            const auto x = choose(u.x, node.share[0] + node.share[2], node.share[1] + node.share[3]);
            const auto y = choose(u.y, node.share[x], node.share[x + 2]);
            const unsigned quadrant = 2 * y + x;
            width *= 0.5f;
            s.p.x += static_cast<float>(x) * width;
            s.p.y += static_cast<float>(y) * width;
            s.pdf *= 4 * node.share[quadrant];
            at = child(node, quadrant);
        }
        s.p.x = below_one(s.p.x + u.x * width);
        s.p.y = below_one(s.p.y + u.y * width);
        return s;
    }
    // Per unit area; p in [0, 1]^2.
    float pdf(Vec2f p) const {
        float density = 1;
        for (const Node* at = root(); at != nullptr;) {
            const Node& node = *at;
            const unsigned quadrant = (p.x >= 0.5f ? 1 : 0) + (p.y >= 0.5f ? 2 : 0);
            p.x = 2 * p.x - static_cast<float>(quadrant & 1);
            p.y = 2 * p.y - static_cast<float>(quadrant >> 1);
            density *= 4 * node.share[quadrant];
            at = child(node, quadrant);
        }
        return density;
    }

    std::size_t node_count() const { return nodes_.size(); }
    std::size_t bytes() const { return nodes_.size() * sizeof(Node); }

    void save(ByteWriter& out) const;
    // Throws Error for what save() did not write.
    static QuadtreeDensity load(ByteReader& in);

  private:
    struct Node {
        std::array<float, 4> share{};         // of the node's mass, by quadrant: x + 2 y; they sum to 1
        std::array<std::uint16_t, 4> child{}; // 0: the quadrant is not split
    };
    struct Builder;

    const Node* root() const { return nodes_.empty() ? nullptr : nodes_.data(); }
    const Node* child(const Node& node, unsigned quadrant) const {
        const std::uint16_t n = node.child[quadrant];
        return n == 0 ? nullptr : &nodes_[n];
    }

    // 0 or 1 with these shares; u becomes uniform again.
    static unsigned choose(float& u, float low, float high) {
        const float at = low / (low + high);
        if (high == 0 || u < at) {
            u = below_one(u / at);
            return 0;
        }
        u = below_one((u - at) / (1 - at));
        return 1;
    }
    static float below_one(float u) { return u < 0x1.fffffep-1f ? u : 0x1.fffffep-1f; }

    std::vector<Node> nodes_; // children follow their parents
    double second_moment_ = 0;
};

} // namespace montelux
