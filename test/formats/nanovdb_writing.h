// NanoVDB files for tests, written by NanoVDB itself.
#pragma once

#define NANOVDB_USE_ZIP
#include <cstdint>
#include <cstring>
#include <nanovdb/util/GridBuilder.h>
#include <nanovdb/util/IO.h>
#include <span>
#include <sstream>
#include <string>
#include <vector>

namespace montelux::test {

using Handle = nanovdb::GridHandle<nanovdb::HostBuffer>;

inline std::vector<std::uint8_t> nanovdb_bytes(const std::vector<Handle>& grids,
                                               nanovdb::io::Codec codec = nanovdb::io::Codec::NONE) {
    // A stream in memory cannot be positioned beyond its end, where the headers will be.
    std::size_t headers = 16;
    for (const Handle& grid : grids) headers += 176 + std::strlen(grid.gridMetaData()->shortGridName()) + 1;
    std::stringstream stream(std::string(headers, '\0'), std::ios::in | std::ios::out | std::ios::binary);
    nanovdb::io::writeGrids<nanovdb::HostBuffer, std::vector>(stream, grids, codec);
    const std::string text = stream.str();
    return {text.begin(), text.end()};
}

// A box around the origin, so in eight upper nodes.
inline const nanovdb::CoordBBox eight_nodes(nanovdb::Coord(-9, -3, -12), nanovdb::Coord(13, 19, 3));
// Its part in two of them: a file of a quarter of the size.
inline const nanovdb::CoordBBox two_nodes(nanovdb::Coord(-9, 0, -12), nanovdb::Coord(13, 19, -1));

// A small grid of pseudo-random values, with tiles.
inline Handle small_nanovdb(const std::string& name, nanovdb::ChecksumMode sums = nanovdb::ChecksumMode::Full,
                            nanovdb::GridClass grid_class = nanovdb::GridClass::FogVolume, float least = 0,
                            const nanovdb::CoordBBox& box = eight_nodes) {
    nanovdb::GridBuilder<float> builder(0.0f, grid_class);
    builder.setChecksum(sums);
    auto accessor = builder.getAccessor();
    for (int i = box.min()[0]; i <= box.max()[0]; ++i)
        for (int j = box.min()[1]; j <= box.max()[1]; ++j)
            for (int k = box.min()[2]; k <= box.max()[2]; ++k) {
                const auto hash = static_cast<unsigned>(i) * 73856093u ^
                                  static_cast<unsigned>(j) * 19349663u ^ static_cast<unsigned>(k) * 83492791u;
                const bool constant = i >= 0 && i < 8 && j >= 8 && j < 16 && k < 0 && k >= -8;
                accessor.setValue(nanovdb::Coord(i, j, k),
                                  constant ? 0.5f : least + static_cast<float>(hash % 89) / 89);
            }
    return builder.getHandle(0.5, nanovdb::Vec3d(1, 2, 3), name);
}

} // namespace montelux::test
