// SparseGrid: values of voxels on a lattice, stored in blocks of 8^3 where they are not constant.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "montelux/mc/math/vec.h"
#include "montelux/mc/math/vector_bytes.h"

namespace montelux {

// Voxel (i, j, k) with 0 <= i < 128 node_count[0] and so on has its value at the point (i, j, k) of grid space;
// all other voxels have the value `background`. Two levels of tables lead to a block: nodes of 16^3 blocks. An
// entry of a table is the index of a node or block, or that of a constant value (`constant_entry`).
class SparseGrid {
  public:
    static constexpr int block_width = 8, node_width = 128;
    static constexpr std::uint32_t constant_entry = std::uint32_t{1} << 31; // plus an index into `constants`
    static constexpr std::size_t block_size = 512, node_size = 4096;

    std::array<int, 3> node_count{0, 0, 0};
    std::vector<std::uint32_t>
        nodes; // (x node_count[1] + y) node_count[2] + z, an index into `blocks` / 4096
    std::vector<std::uint32_t> blocks;  // in each node: 256 x + 16 y + z, an index into `values` / 512
    std::vector<float> values;          // in each block: 64 x + 8 y + z
    std::vector<float> constants{0.0f}; // the first is that of all voxels outside

    float background() const { return constants[0]; }
    std::size_t block_count() const { return values.size() / block_size; }
    std::size_t bytes() const { return vector_bytes(nodes, blocks, values, constants); }

    float value(int i, int j, int k) const {
        const std::uint32_t entry = block_entry(i, j, k);
        if ((entry & constant_entry) != 0) return constants[entry & ~constant_entry];
        return values[entry * block_size + in_block(i, j, k)];
    }
    // Interpolated trilinearly between voxels. NaN is a point outside.
    float operator()(Point3f p) const;
    // The largest value that interpolation may take for points of a box. Not less than 0.
    float largest(Point3f lower, Point3f upper) const;

    // Voxels lower[a] <= i <= upper[a]; none if lower[a] > upper[a].
    struct VoxelRange {
        std::array<int, 3> lower{0, 0, 0}, upper{-1, -1, -1};

        bool empty() const { return lower[0] > upper[0] || lower[1] > upper[1] || lower[2] > upper[2]; }
    };
    // All voxels that are not 0, for a background of 0.
    VoxelRange non_zero() const;
    // visit(value) for every value that is stored.
    template <typename Visit>
    void for_each_value(const Visit& visit) const {
        for (const float v : constants) visit(v);
        for (const float v : values) visit(v);
    }
    // Whether the tables have their sizes and all entries lead somewhere.
    bool is_consistent() const;

  private:
    static std::size_t in_block(int i, int j, int k) {
        return static_cast<std::size_t>((i & 7) << 6 | (j & 7) << 3 | (k & 7));
    }
    // The entry of the block that contains a voxel.
    std::uint32_t block_entry(int i, int j, int k) const {
        const int x = i >> 7, y = j >> 7, z = k >> 7;
        if (x < 0 || y < 0 || z < 0 || x >= node_count[0] || y >= node_count[1] || z >= node_count[2])
            return constant_entry;
        const std::uint32_t node =
            nodes[(static_cast<std::size_t>(x) * static_cast<std::size_t>(node_count[1]) +
                   static_cast<std::size_t>(y)) *
                      static_cast<std::size_t>(node_count[2]) +
                  static_cast<std::size_t>(z)];
        if ((node & constant_entry) != 0) return node;
        const auto block = static_cast<std::size_t>((i >> 3 & 15) << 8 | (j >> 3 & 15) << 4 | (k >> 3 & 15));
        return blocks[node * node_size + block];
    }
    // visit(first voxel of the block, entry) for every block, and (first voxel of the node, entry, 128) for
    // every constant node, that overlaps a range; the third argument is the width.
    template <typename Visit>
    void for_each_block(const VoxelRange& range, const Visit& visit) const;
};

inline float SparseGrid::operator()(Point3f p) const {
    std::array<int, 3> c{};
    std::array<float, 3> f{};
    for (int a = 0; a < 3; ++a) {
        const auto at = static_cast<std::size_t>(a);
        // Far outside is as good as just outside; NaN as well.
        const float x = std::min(std::max(p[a], -2.0f), static_cast<float>(node_count[at] * node_width + 1));
        const float floor = std::floor(x);
        c[at] = static_cast<int>(floor);
        f[at] = x - floor;
    }
    std::array<float, 8> v{};                                    // 4 x + 2 y + z
    if ((c[0] & 7) != 7 && (c[1] & 7) != 7 && (c[2] & 7) != 7) { // all in one block
        const std::uint32_t entry = block_entry(c[0], c[1], c[2]);
        if ((entry & constant_entry) != 0) return constants[entry & ~constant_entry];
        const float* at = &values[entry * block_size + in_block(c[0], c[1], c[2])];
        v = {at[0], at[1], at[8], at[9], at[64], at[65], at[72], at[73]};
    } else {
        for (int n = 0; n < 8; ++n)
            v[static_cast<std::size_t>(n)] = value(c[0] + (n >> 2), c[1] + (n >> 1 & 1), c[2] + (n & 1));
    }
    const auto mix = [](float a, float b, float t) { return a * (1 - t) + b * t; };
    return mix(mix(mix(v[0], v[1], f[2]), mix(v[2], v[3], f[2]), f[1]),
               mix(mix(v[4], v[5], f[2]), mix(v[6], v[7], f[2]), f[1]), f[0]);
}

} // namespace montelux
