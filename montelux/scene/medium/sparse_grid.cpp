#include "montelux/scene/medium/sparse_grid.h"

namespace montelux {

template <typename Visit>
void SparseGrid::for_each_block(const VoxelRange& range, const Visit& visit) const {
    const auto clipped = [&](std::size_t a, int width, int within_lower, int within_upper) {
        return std::array{std::max(range.lower[a], within_lower) / width,
                          std::min(range.upper[a], within_upper) / width};
    };
    std::array<std::array<int, 2>, 3> n{};
    for (std::size_t a = 0; a < 3; ++a) {
        if (std::min(range.upper[a], node_count[a] * node_width - 1) < std::max(range.lower[a], 0)) return;
        n[a] = clipped(a, node_width, 0, node_count[a] * node_width - 1);
    }
    for (int x = n[0][0]; x <= n[0][1]; ++x)
        for (int y = n[1][0]; y <= n[1][1]; ++y)
            for (int z = n[2][0]; z <= n[2][1]; ++z) {
                const std::array<int, 3> first{x * node_width, y * node_width, z * node_width};
                const std::uint32_t node =
                    nodes[(static_cast<std::size_t>(x) * static_cast<std::size_t>(node_count[1]) +
                           static_cast<std::size_t>(y)) *
                              static_cast<std::size_t>(node_count[2]) +
                          static_cast<std::size_t>(z)];
                if ((node & constant_entry) != 0) {
                    visit(first, node, node_width);
                    continue;
                }
                std::array<std::array<int, 2>, 3> b{};
                for (std::size_t a = 0; a < 3; ++a)
                    b[a] = clipped(a, block_width, first[a], first[a] + node_width - 1);
                for (int i = b[0][0]; i <= b[0][1]; ++i)
                    for (int j = b[1][0]; j <= b[1][1]; ++j)
                        for (int k = b[2][0]; k <= b[2][1]; ++k) {
                            const auto place =
                                static_cast<std::size_t>((i & 15) << 8 | (j & 15) << 4 | (k & 15));
                            visit(std::array{i * block_width, j * block_width, k * block_width},
                                  blocks[node * node_size + place], block_width);
                        }
            }
}

float SparseGrid::largest(Point3f lower, Point3f upper) const {
    VoxelRange range;
    bool beyond = false;
    for (int a = 0; a < 3; ++a) {
        const auto at = static_cast<std::size_t>(a);
        const auto end = static_cast<float>(node_count[at] * node_width);
        // Points may lie outside the box by rounding.
        const float margin = 1e-3f + 1e-6f * end;
        range.lower[at] = static_cast<int>(std::floor(std::clamp(lower[a] - margin, -2.0f, end)));
        range.upper[at] = static_cast<int>(std::floor(std::clamp(upper[a] + margin, -2.0f, end))) + 1;
        beyond = beyond || range.lower[at] < 0 || range.upper[at] >= node_count[at] * node_width;
    }
    float result = beyond ? std::max(background(), 0.0f) : 0;
    for_each_block(range, [&](const std::array<int, 3>& first, std::uint32_t entry, int) {
        if ((entry & constant_entry) != 0) {
            result = std::max(result, constants[entry & ~constant_entry]);
            return;
        }
        std::array<int, 3> from{}, to{};
        for (std::size_t a = 0; a < 3; ++a) {
            from[a] = std::max(range.lower[a] - first[a], 0);
            to[a] = std::min(range.upper[a] - first[a], block_width - 1);
        }
        const float* block = &values[entry * block_size];
        for (int i = from[0]; i <= to[0]; ++i)
            for (int j = from[1]; j <= to[1]; ++j)
                for (int k = from[2]; k <= to[2]; ++k) result = std::max(result, block[in_block(i, j, k)]);
    });
    return result;
}

SparseGrid::VoxelRange SparseGrid::non_zero() const {
    VoxelRange all, result;
    for (std::size_t a = 0; a < 3; ++a) {
        all.upper[a] = result.lower[a] = node_count[a] * node_width - 1;
        result.upper[a] = -1;
    }
    const auto extend = [&](std::array<int, 3> lower, std::array<int, 3> upper) {
        for (std::size_t a = 0; a < 3; ++a) {
            result.lower[a] = std::min(result.lower[a], lower[a]);
            result.upper[a] = std::max(result.upper[a], upper[a]);
        }
    };
    for_each_block(all, [&](const std::array<int, 3>& first, std::uint32_t entry, int width) {
        if ((entry & constant_entry) != 0) {
            if (constants[entry & ~constant_entry] != 0)
                extend(first, {first[0] + width - 1, first[1] + width - 1, first[2] + width - 1});
            return;
        }
        const float* block = &values[entry * block_size];
        for (int i = 0; i < block_width; ++i)
            for (int j = 0; j < block_width; ++j)
                for (int k = 0; k < block_width; ++k)
                    if (block[in_block(i, j, k)] != 0) {
                        const std::array<int, 3> voxel{first[0] + i, first[1] + j, first[2] + k};
                        extend(voxel, voxel);
                    }
    });
    return result.upper[0] < 0 ? VoxelRange{} : result;
}

bool SparseGrid::is_consistent() const {
    std::size_t count = 1;
    for (const int n : node_count) {
        if (n < 0 || n > 1 << 20) return false;
        count *= static_cast<std::size_t>(n);
    }
    if (constants.empty() || nodes.size() != count || blocks.size() % node_size != 0 ||
        values.size() % block_size != 0)
        return false;
    const auto leads = [&](std::uint32_t entry, std::size_t size) {
        return (entry & constant_entry) != 0 ? (entry & ~constant_entry) < constants.size() : entry < size;
    };
    return std::all_of(nodes.begin(), nodes.end(),
                       [&](std::uint32_t e) { return leads(e, blocks.size() / node_size); }) &&
           std::all_of(blocks.begin(), blocks.end(),
                       [&](std::uint32_t e) { return leads(e, block_count()); });
}

} // namespace montelux
