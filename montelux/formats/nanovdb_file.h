// NanovdbFile: the grids of numbers in a NanoVDB file, checked and copied into sparse grids.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/mc/math/transform.h"
#include "montelux/scene/medium/sparse_grid.h"

namespace montelux {

// A grid and its place in the space of the file.
struct PlacedSparseGrid {
    SparseGrid grid;
    Transform file_from_grid; // from grid space, in which voxels have integer coordinates; affine
};

// Museth 2021, "NanoVDB: A GPU-Friendly and Portable VDB Data Structure For Real-Time Rendering And Simulation".
// Files of version 32, uncompressed or compressed by zlib or, where the program was built with it, by Blosc. They are
// not trusted: all sizes, offsets and values are checked, and no node may have two parents.
class NanovdbFile {
  public:
    static const bool reads_blosc;

    // Reads the table of contents. `bytes` must outlive it; `name` is that of the file, for messages. Throws Error.
    NanovdbFile(std::span<const std::uint8_t> bytes, std::string name);

    bool contains(std::string_view grid) const { return find(grid) != nullptr; }
    // Of all grids, for messages.
    std::string grid_names() const;
    // The first grid of that name. Throws Error for none, for one of values that are no numbers, and for a level set.
    PlacedSparseGrid read(std::string_view grid) const;

  private:
    struct Entry {
        std::string name;
        std::uint64_t unpacked_size = 0;
        std::span<const std::uint8_t> stored;
        std::uint16_t codec = 0;
    };
    const Entry* find(std::string_view grid) const;

    std::string name_;
    std::vector<Entry> entries_;
};

} // namespace montelux
