// Sparse grids from functions of voxels, for tests.
#pragma once

#include <algorithm>

#include "montelux/scene/medium/sparse_grid.h"

namespace montelux::testing {

// density(i, j, k) for all voxels of `nodes` nodes along each axis. Equal blocks become constants.
template <typename Density>
SparseGrid sparse_grid(std::array<int, 3> nodes, const Density& density) {
    SparseGrid g;
    g.node_count = nodes;
    for (int x = 0; x < nodes[0]; ++x)
        for (int y = 0; y < nodes[1]; ++y)
            for (int z = 0; z < nodes[2]; ++z) {
                g.nodes.push_back(static_cast<std::uint32_t>(g.blocks.size() / SparseGrid::node_size));
                for (int b = 0; b < 4096; ++b) {
                    std::array<float, 512> values{};
                    for (int n = 0; n < 512; ++n)
                        values[static_cast<std::size_t>(n)] = density(
                            128 * x + 8 * (b >> 8) + (n >> 6), 128 * y + 8 * (b >> 4 & 15) + (n >> 3 & 7),
                            128 * z + 8 * (b & 15) + (n & 7));
                    if (std::all_of(values.begin(), values.end(), [&](float v) { return v == values[0]; })) {
                        const auto found = std::find(g.constants.begin(), g.constants.end(), values[0]);
                        g.blocks.push_back(SparseGrid::constant_entry |
                                           static_cast<std::uint32_t>(found - g.constants.begin()));
                        if (found == g.constants.end()) g.constants.push_back(values[0]);
                    } else {
                        g.blocks.push_back(static_cast<std::uint32_t>(g.block_count()));
                        g.values.insert(g.values.end(), values.begin(), values.end());
                    }
                }
            }
    return g;
}

} // namespace montelux::testing
