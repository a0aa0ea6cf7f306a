// NanoVDB files as other writers make them: leaves of every number of bits, tiles of the root, newer versions, several
// compressed chunks.
#include "test/formats/nanovdb_writing.h"
#include <algorithm>
#include <array>
#include <cstddef>
#include <gtest/gtest.h>

#include "montelux/formats/nanovdb_file.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// Of a file of one grid without compression.
constexpr std::size_t file_header = 16, grid_record = 176;
std::size_t grid_at(const std::string& name) { return file_header + grid_record + name.size() + 1; }

template <typename T>
T number_at(const std::vector<std::uint8_t>& bytes, std::size_t at) {
    T value{};
    std::memcpy(&value, &bytes[at], sizeof value);
    return value;
}
template <typename T>
void put_number(std::vector<std::uint8_t>& bytes, std::size_t at, T value) {
    std::memcpy(&bytes[at], &value, sizeof value);
}

std::vector<std::uint8_t> plain_file(test::Handle handle) {
    std::vector<test::Handle> grids;
    grids.push_back(std::move(handle));
    return test::nanovdb_bytes(grids);
}
test::Handle small_grid(nanovdb::ChecksumMode sums = nanovdb::ChecksumMode::Full) {
    return test::small_nanovdb("density", sums);
}
SparseGrid values_of(const std::vector<std::uint8_t>& bytes) {
    return NanovdbFile(bytes, "f").read("density").grid;
}

// Leaf n holds 2^(2^n) values in even steps, which take 2^n bits each.
TEST(NanovdbVariants, LeavesOfEveryNumberOfBits) {
    const auto value = [](int leaf, int voxel) {
        const int codes = 1 << (1 << leaf);
        const int code = voxel == 0 ? 0 : voxel == 511 ? codes - 1 : voxel * 40503 % codes;
        return 0.25f + static_cast<float>(leaf) + static_cast<float>(code) / static_cast<float>(codes - 1);
    };
    const auto place = [](int leaf, int voxel) {
        return nanovdb::Coord(8 * leaf + voxel / 64, voxel / 8 % 8, voxel % 8);
    };
    nanovdb::GridBuilder<float, nanovdb::FpN> builder(0.0f, nanovdb::GridClass::FogVolume);
    builder.setChecksum(nanovdb::ChecksumMode::Full);
    auto accessor = builder.getAccessor();
    for (int leaf = 0; leaf < 5; ++leaf)
        for (int voxel = 0; voxel < 512; ++voxel) accessor.setValue(place(leaf, voxel), value(leaf, voxel));
    test::Handle handle = builder.getHandle(1.0, nanovdb::Vec3d(0), "density", nanovdb::AbsDiff(2e-6f));
    for (int leaf = 0; leaf < 5; ++leaf) {
        const auto found = handle.grid<nanovdb::FpN>()->getAccessor();
        EXPECT_EQ(found.probeLeaf(place(leaf, 0))->data()->bitWidth(), 1 << leaf);
    }
    const SparseGrid read = values_of(plain_file(std::move(handle)));
    for (int leaf = 0; leaf < 5; ++leaf)
        for (int voxel = 0; voxel < 512; ++voxel) {
            const nanovdb::Coord at = place(leaf, voxel);
            ASSERT_NEAR(read.value(at[0], at[1], at[2]), value(leaf, voxel), 3e-6f) << leaf << ' ' << voxel;
        }
}

// A tile of the root fills 4096^3 voxels.
TEST(NanovdbVariants, TilesOfTheRoot) {
    std::vector<std::uint8_t> bytes = plain_file(small_grid(nanovdb::ChecksumMode::Disable));
    using Root = nanovdb::NanoRoot<float>::DataType;
    using Tile = Root::Tile;
    const std::size_t grid = grid_at("density"), tree = grid + sizeof(nanovdb::GridData),
                      root = tree + static_cast<std::size_t>(number_at<std::uint64_t>(bytes, tree + 24)),
                      tiles = root + sizeof(Root);
    const auto count = number_at<std::uint32_t>(bytes, root + offsetof(Root, mTableSize));
    ASSERT_EQ(count, 8u);
    // Behind the others; what follows it moves.
    Tile tile{};
    tile.key = Root::CoordToKey(nanovdb::Coord(4096, 0, -4096));
    tile.value = 0.25f;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t child = tiles + i * sizeof(Tile) + offsetof(Tile, child);
        put_number(bytes, child, number_at<std::int64_t>(bytes, child) + std::int64_t{sizeof(Tile)});
    }
    for (std::size_t level = 0; level < 3; ++level)
        put_number(bytes, tree + 8 * level, number_at<std::uint64_t>(bytes, tree + 8 * level) + sizeof(Tile));
    put_number(bytes, root + offsetof(Root, mTableSize), count + 1);
    for (std::size_t i = 0; i < 2; ++i) // unpacked and stored size
        put_number(bytes, file_header + 8 * i,
                   number_at<std::uint64_t>(bytes, file_header + 8 * i) + sizeof(Tile));
    const auto* const first = reinterpret_cast<const std::uint8_t*>(&tile);
    bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(tiles + count * sizeof(Tile)), first,
                 first + sizeof(Tile));

    const PlacedSparseGrid read = NanovdbFile(bytes, "f").read("density"),
                           plain = NanovdbFile(plain_file(small_grid()), "f").read("density");
    const auto at = [](const PlacedSparseGrid& g, double i, double j, double k) {
        // Voxels are half as wide as units of the file, and the grid begins at (1, 2, 3).
        return g.grid(
            Point3f(g.file_from_grid.inverse().point(Vec3d{1 + 0.5 * i, 2 + 0.5 * j, 3 + 0.5 * k})));
    };
    for (const double i : {4096, 5000, 8191})
        for (const double j : {0, 200, 4095})
            for (const double k : {-4096, -129, -1}) EXPECT_EQ(at(read, i, j, k), 0.25f) << i << j << k;
    for (const auto& outside : {std::array{4095, 5, -5}, std::array{8193, 5, -5}, std::array{5000, -1, -5},
                                std::array{5000, 5, 1}, std::array{5000, 5, -4097}})
        EXPECT_EQ(at(read, outside[0], outside[1], outside[2]), 0) << outside[0] << ' ' << outside[1];
    for (int i = -9; i < 14; ++i) EXPECT_EQ(at(read, i, 5, -3), at(plain, i, 5, -3)) << i;
}

// From version 32.6 on files and grids have other marks, and checksums that are computed in another way.
TEST(NanovdbVariants, NewerVersionsAreRead) {
    const std::vector<std::uint8_t> good = plain_file(small_grid());
    const std::size_t grid = grid_at("density");
    const std::uint32_t version = 32u << 21 | 6u << 10;
    std::vector<std::uint8_t> newer = good;
    put_number(newer, 0, std::uint64_t{0x324244566f6e614e});    // NanoVDB2
    put_number(newer, grid, std::uint64_t{0x314244566f6e614e}); // NanoVDB1
    put_number(newer, 8, version);
    put_number(newer, grid + 16, version);
    put_number(newer, grid + 8, std::uint64_t{0x123456789});
    EXPECT_EQ(values_of(newer).values, values_of(good).values);
    put_number(newer, grid, std::uint64_t{0x334244566f6e614e});
    EXPECT_THROW(values_of(newer), Error);
}

// The data must have the size that the file says.
TEST(NanovdbVariants, CompressedDataOfAnotherSizeIsRefused) {
    std::vector<test::Handle> grids;
    grids.push_back(small_grid(nanovdb::ChecksumMode::Disable));
    const std::vector<std::uint8_t> good = test::nanovdb_bytes(grids, nanovdb::io::Codec::ZIP);
    EXPECT_GT(values_of(good).block_count(), 0u);
    for (const int by : {-64, 64}) {
        std::vector<std::uint8_t> bytes = good;
        put_number(bytes, file_header,
                   number_at<std::uint64_t>(bytes, file_header) + static_cast<std::uint64_t>(by));
        EXPECT_THROW(values_of(bytes), Error) << by;
    }
}

#ifdef NANOVDB_USE_BLOSC
// NanoVDB begins a new chunk after each GiB.
TEST(NanovdbVariants, BloscInSeveralChunks) {
    const std::vector<std::uint8_t> good = plain_file(small_grid());
    const std::size_t grid = grid_at("density"), size = good.size() - grid;
    std::vector<std::uint8_t> bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(grid));
    for (std::size_t begin = 0; begin < size; begin += 100000) {
        const std::size_t part = std::min<std::size_t>(100000, size - begin);
        std::vector<std::uint8_t> packed(part + BLOSC_MAX_OVERHEAD);
        const int count = blosc_compress_ctx(9, 1, 4, part, &good[grid + begin], packed.data(), packed.size(),
                                             BLOSC_LZ4_COMPNAME, 0, 1);
        ASSERT_GT(count, 0);
        packed.resize(static_cast<std::size_t>(count));
        const std::size_t at = bytes.size();
        bytes.resize(at + 8);
        put_number(bytes, at, std::uint64_t{packed.size()});
        bytes.insert(bytes.end(), packed.begin(), packed.end());
    }
    put_number(bytes, 14, std::uint16_t{2});
    put_number(bytes, file_header + 8, std::uint64_t{bytes.size() - grid});
    EXPECT_GT(size, 300000u);
    EXPECT_EQ(values_of(bytes).values, values_of(good).values);
}
#endif

} // namespace
} // namespace montelux
