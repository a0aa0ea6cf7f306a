// NanoVDB files that NanoVDB has written, read and looked up beside NanoVDB's own sampler; damaged ones.
#include "test/formats/nanovdb_writing.h"
#include "test/sanitized.h"
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <nanovdb/util/Primitives.h>
#include <nanovdb/util/SampleFromVoxels.h>
#include <random>

#include "montelux/formats/nanovdb_file.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

using test::Handle;
using test::nanovdb_bytes;
using test::small_nanovdb;

std::string error_of_file(std::span<const std::uint8_t> bytes, std::string_view grid = "density") {
    try {
        NanovdbFile(bytes, "f.nvdb").read(grid);
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}

// At random points of the file's space in and around the grid.
void expect_same_values(const Handle& handle, const PlacedSparseGrid& read) {
    EXPECT_TRUE(read.grid.is_consistent());
    const nanovdb::NanoGrid<float>& grid = *handle.grid<float>();
    const auto accessor = grid.getAccessor();
    const auto sampler = nanovdb::createSampler<1>(accessor);
    const auto box = grid.tree().bbox();
    std::mt19937 random(4);
    const Transform grid_from_file = read.file_from_grid.inverse();
    int some = 0;
    for (int n = 0; n < 50000; ++n) {
        nanovdb::Vec3d index;
        for (int a = 0; a < 3; ++a)
            index[a] = std::uniform_real_distribution<double>(box.min()[a] - 9, box.max()[a] + 9)(random);
        if (n % 3 == 0)
            for (int a = 0; a < 3; ++a) index[a] = std::floor(index[a]); // at a voxel
        const nanovdb::Vec3d at = grid.indexToWorld(index);
        const Point3f p(grid_from_file.point(Vec3d(at[0], at[1], at[2])));
        const nanovdb::Vec3f there(static_cast<float>(index[0]), static_cast<float>(index[1]),
                                   static_cast<float>(index[2]));
        const float expected = sampler(there);
        ASSERT_NEAR(read.grid(p), expected, 2e-4f) << n;
        some += expected > 0;
    }
    EXPECT_GT(some, 2000);
}

// Places of bytes in words of eight that are not 0: offsets, counts, masks, children, values.
std::vector<std::size_t> vital_places(const std::vector<std::uint8_t>& bytes) {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const auto word = bytes.begin() + static_cast<std::ptrdiff_t>(i / 8 * 8);
        if (std::any_of(word, word + std::min<std::ptrdiff_t>(8, bytes.end() - word),
                        [](std::uint8_t byte) { return byte != 0; }))
            places.push_back(i);
    }
    return places;
}

template <typename... H>
std::vector<Handle> handles(H&&... h) {
    std::vector<Handle> result;
    (result.push_back(std::forward<H>(h)), ...);
    return result;
}

TEST(NanovdbFile, LookUpsEqualThoseOfNanovdb) {
    for (const auto codec : {nanovdb::io::Codec::NONE, nanovdb::io::Codec::ZIP}) {
        const auto grids = handles(small_nanovdb("density"));
        const auto bytes = nanovdb_bytes(grids, codec);
        const PlacedSparseGrid read = NanovdbFile(bytes, "f").read("density");
        expect_same_values(grids[0], read);
        EXPECT_EQ(read.grid.block_count(), 47u); // of 48: one is constant
    }
}

// Voxel by voxel, as NanoVDB decodes them.
template <typename Value, typename Build>
void expect_decoded(nanovdb::GridBuilder<Value, Build>& builder, double largest_error) {
    auto accessor = builder.getAccessor();
    const auto value = [](int i, int j, int k) { return 0.5 + 0.5 * std::sin(0.37 * i + 0.11 * j * k); };
    for (int i = -20; i < 20; ++i)
        for (int j = 0; j < 30; ++j)
            for (int k = 120; k < 140; ++k)
                accessor.setValue(nanovdb::Coord(i, j, k), static_cast<Value>(value(i, j, k)));
    // A leaf of one value but for one voxel: few bits.
    for (int n = 0; n < 512; ++n)
        accessor.setValue(nanovdb::Coord(80 + n / 64, n / 8 % 8, n % 8),
                          static_cast<Value>(n == 7 ? 1 : 0.25));
    const auto grids = handles(builder.getHandle(1.0, nanovdb::Vec3d(0), "density"));
    const auto bytes = nanovdb_bytes(grids, nanovdb::io::Codec::ZIP);
    const PlacedSparseGrid read = NanovdbFile(bytes, "f").read("density");
    EXPECT_TRUE(read.grid.is_consistent());
    const auto& tree = grids[0].template grid<Build>()->tree();
    const Transform grid_from_file = read.file_from_grid.inverse();
    double largest = 0;
    for (int i = -22; i < 90; ++i)
        for (int j = -2; j < 32; ++j)
            for (int k = -1; k < 141; ++k) {
                const Point3f p(grid_from_file.point(Vec3d(i, j, k)));
                const auto expected = static_cast<float>(tree.getValue(nanovdb::Coord(i, j, k)));
                ASSERT_EQ(read.grid(p), expected) << i << ' ' << j << ' ' << k;
                if (i >= -20 && i < 20 && j >= 0 && j < 30 && k >= 120 && k < 140)
                    largest = std::max(largest, std::abs(double(expected) - value(i, j, k)));
            }
    EXPECT_LT(largest, largest_error);
    // Damaged bytes are refused or harmless, without checksums, which would hide the tree.
    std::mt19937 random(8);
    auto plain = nanovdb_bytes(grids);
    const std::size_t checksum = 16 + 176 + 8 + 8;
    std::fill_n(&plain[checksum], 8, std::uint8_t{0xff});
    const std::vector<std::size_t> vital = vital_places(plain);
    for (int n = 0; n < 60; ++n) {
        auto broken = plain;
        for (int c = 0; c < 3; ++c)
            broken[vital[random() % vital.size()]] ^= static_cast<std::uint8_t>(1 + random() % 255);
        try {
            EXPECT_TRUE(NanovdbFile(broken, "f").read("density").grid.is_consistent());
        } catch (const Error&) {
        }
    }
}

TEST(NanovdbFile, ValuesOfEveryType) {
    nanovdb::GridBuilder<double> doubles(0.0, nanovdb::GridClass::FogVolume);
    expect_decoded(doubles, 1e-7);
    nanovdb::GridBuilder<float, nanovdb::Fp4> fp4(0.0f, nanovdb::GridClass::FogVolume);
    expect_decoded(fp4, 0.07);
    nanovdb::GridBuilder<float, nanovdb::Fp8> fp8(0.0f, nanovdb::GridClass::FogVolume);
    expect_decoded(fp8, 0.005);
    nanovdb::GridBuilder<float, nanovdb::Fp16> fp16(0.0f, nanovdb::GridClass::FogVolume);
    expect_decoded(fp16, 2e-5);
    nanovdb::GridBuilder<float, nanovdb::FpN> fpn(0.0f, nanovdb::GridClass::FogVolume);
    expect_decoded(fpn, 0.05);
}

#ifdef NANOVDB_USE_BLOSC
TEST(NanovdbFile, CompressedByBlosc) {
    const auto grids = handles(small_nanovdb("density"));
    const auto bytes = nanovdb_bytes(grids, nanovdb::io::Codec::BLOSC);
    ASSERT_TRUE(NanovdbFile::reads_blosc);
    expect_same_values(grids[0], NanovdbFile(bytes, "f").read("density"));
    std::mt19937 random(3);
    for (int n = 0; n < 300; ++n) {
        auto broken = bytes;
        for (int c = 0; c < 2; ++c)
            broken[200 + random() % (broken.size() - 200)] ^= static_cast<std::uint8_t>(1 + random() % 255);
        try {
            EXPECT_TRUE(NanovdbFile(broken, "f").read("density").grid.is_consistent());
        } catch (const Error&) {
        }
    }
}
#endif

// Large tiles of one value inside.
TEST(NanovdbFile, LookUpsInTilesEqualThoseOfNanovdb) {
    const auto grids = handles(nanovdb::createFogVolumeSphere<float>(90.0f, nanovdb::Vec3f(40, -70, 10), 1.0,
                                                                     3.0, nanovdb::Vec3d(0), "density"));
    const PlacedSparseGrid read = NanovdbFile(nanovdb_bytes(grids), "f").read("density");
    expect_same_values(grids[0], read);
    // Those of the surface, about 4 pi 90^2 / 8^2 times the width of the band.
    EXPECT_LT(read.grid.block_count(), 5000u);

    nanovdb::GridBuilder<float> builder(0.0f, nanovdb::GridClass::FogVolume);
    builder([](const nanovdb::Coord&) { return 0.75f; }, // a node of 128^3 and more
            nanovdb::CoordBBox(nanovdb::Coord(-130, 0, 0), nanovdb::Coord(270, 140, 130)));
    const auto box = handles(builder.getHandle(2.0, nanovdb::Vec3d(1), "density"));
    const PlacedSparseGrid read_box = NanovdbFile(nanovdb_bytes(box), "f").read("density");
    expect_same_values(box[0], read_box);
    EXPECT_LT(read_box.grid.block_count(), 4000u);
}

TEST(NanovdbFile, MapsWithRotationAndShear) {
    nanovdb::GridBuilder<float> builder(0.0f, nanovdb::GridClass::Unknown);
    auto accessor = builder.getAccessor();
    for (int n = 0; n < 4000; ++n)
        accessor.setValue(nanovdb::Coord(n % 16, n / 16 % 16, n / 256 - 300),
                          1 + 0.001f * static_cast<float>(n));
    nanovdb::Map map;
    const double m[3][3] = {{0.4, 0.1, 0}, {-0.2, 0.5, 0.3}, {0, 0.05, -0.6}};
    const double det = 0.4 * (0.5 * -0.6 - 0.3 * 0.05) - 0.1 * (-0.2 * -0.6);
    double inverse[3][3];
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            const int a = (k + 1) % 3, b = (k + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
            inverse[i][k] = (m[a][c] * m[b][d] - m[a][d] * m[b][c]) / det;
        }
    const double translation[3] = {10, -20, 30};
    map.set(m, inverse, translation, 1.0);
    const auto grids = handles(builder.getHandle(map, "density"));
    expect_same_values(grids[0], NanovdbFile(nanovdb_bytes(grids), "f").read("density"));
}

TEST(NanovdbFile, GridsAreFoundByName) {
    const auto grids = handles(small_nanovdb("a"), small_nanovdb("density"), small_nanovdb("c"));
    auto bytes = nanovdb_bytes(grids, nanovdb::io::Codec::ZIP);
    // A second segment.
    const auto more = nanovdb_bytes(handles(small_nanovdb("d")));
    bytes.insert(bytes.end(), more.begin(), more.end());
    const NanovdbFile file(bytes, "f");
    EXPECT_EQ(file.grid_names(), "'a', 'density', 'c', 'd'");
    EXPECT_TRUE(file.contains("d"));
    EXPECT_FALSE(file.contains("e"));
    expect_same_values(grids[1], file.read("density"));
    expect_same_values(grids[0], file.read("d"));
    EXPECT_EQ(error_of_file(bytes, "e"), "f.nvdb: has no grid 'e'; it has 'a', 'density', 'c', 'd'");
}

TEST(NanovdbFile, WhatItCannotReadIsSaid) {
    const auto good = nanovdb_bytes(handles(small_nanovdb("density")));
    EXPECT_EQ(error_of_file(good), "");
    const auto changed = [&](const auto& change) {
        auto bytes = good;
        change(bytes);
        return error_of_file(bytes);
    };
    using Bytes = std::vector<std::uint8_t>;
    EXPECT_EQ(error_of_file({}), "f.nvdb: is no NanoVDB file (.nvdb)");
    EXPECT_EQ(changed([](Bytes& b) { b[0] = 'n'; }), "f.nvdb: is no NanoVDB file (.nvdb)");
    EXPECT_EQ(changed([](Bytes& b) { b.push_back(0); }), "f.nvdb: ends early");
    EXPECT_EQ(changed([](Bytes& b) { b.pop_back(); }), "f.nvdb: grid 'density' ends early");
    EXPECT_EQ(changed([](Bytes& b) { b[11] = 31 << 5 >> 3; }).substr(0, 29), "f.nvdb: has NanoVDB's version");
    EXPECT_EQ(changed([](Bytes& b) { b[14] = 2; }),
              NanovdbFile::reads_blosc
                  ? "f.nvdb, grid 'density': the compressed data ends early"
                  : "f.nvdb: is compressed by Blosc, without which this program was built; convert it with "
                    "nanovdb_convert to zip or to no compression");
    EXPECT_EQ(changed([](Bytes& b) { b[14] = 7; }), "f.nvdb: has an unknown compression, 7");
    EXPECT_EQ(changed([](Bytes& b) { b[b.size() - 1] ^= 1; }),
              "f.nvdb, grid 'density': the checksum does not fit: the file is damaged");
    EXPECT_EQ(changed([](Bytes& b) { b[16 + 176 + 8 + 400] ^= 1; }), // its transformation
              "f.nvdb, grid 'density': the checksum does not fit: the file is damaged");

    EXPECT_EQ(error_of_file(nanovdb_bytes(handles(
                  small_nanovdb("density", nanovdb::ChecksumMode::Full, nanovdb::GridClass::LevelSet)))),
              "f.nvdb, grid 'density': has class SDF; expected a fog volume (FOG)");
    nanovdb::GridBuilder<std::int32_t> integers(0, nanovdb::GridClass::Unknown);
    integers.getAccessor().setValue(nanovdb::Coord(1, 2, 3), 1);
    EXPECT_EQ(
        error_of_file(nanovdb_bytes(handles(integers.getHandle(1.0, nanovdb::Vec3d(0), "density")))),
        "f.nvdb, grid 'density': has values of type int32; expected float, double, or a quantised float "
        "(Fp4, Fp8, Fp16, FpN)");
    nanovdb::GridBuilder<double> doubles(0.0, nanovdb::GridClass::FogVolume);
    doubles.getAccessor().setValue(nanovdb::Coord(1, 2, 3), 1e300);
    EXPECT_EQ(error_of_file(nanovdb_bytes(handles(doubles.getHandle(1.0, nanovdb::Vec3d(0), "density")))),
              "f.nvdb, grid 'density': has a value that is not finite");
    const auto of_values = [](std::vector<std::pair<nanovdb::Coord, float>> values) {
        nanovdb::GridBuilder<float> builder(0.0f, nanovdb::GridClass::FogVolume);
        auto accessor = builder.getAccessor();
        for (const auto& [at, value] : values) accessor.setValue(at, value);
        return error_of_file(nanovdb_bytes(handles(builder.getHandle(1.0, nanovdb::Vec3d(0), "density"))));
    };
    using nanovdb::Coord;
    EXPECT_EQ(of_values({{Coord(1, 2, 3), std::nanf("")}}),
              "f.nvdb, grid 'density': has a value that is not finite");
    EXPECT_EQ(
        of_values({{Coord(0, 0, 0), 1.0f}, {Coord(0, 1 << 20, 0), 1.0f}}),
        "f.nvdb, grid 'density': is too large: its voxels spread over 1048704 along axis 1; expected at "
        "most 65536 along each, and 4194304 blocks of 128^3");
    EXPECT_NE(of_values({{Coord(0, 0, 0), 1.0f}, {Coord(60000, 60000, 60000), 1.0f}}), "");
    EXPECT_EQ(of_values({{Coord(0, -30000, 0), 1.0f}, {Coord(0, 30000, 7), 1.0f}}), "");
}

// Two percent of 1000^3 voxels must not take the 4 GB of a dense grid.
TEST(NanovdbFile, LargeSparseGridsStaySmall) {
    nanovdb::GridBuilder<float> builder(0.0f, nanovdb::GridClass::FogVolume);
    std::mt19937 random(3);
    std::size_t voxels = 0;
    for (int n = 0; n < 2000; ++n) { // 1 % of the blocks
        const nanovdb::Coord at(static_cast<int>(random() % 125) * 8, static_cast<int>(random() % 125) * 8,
                                static_cast<int>(random() % 125) * 8);
        auto accessor = builder.getAccessor();
        for (int v = 0; v < 512; v += 3)
            accessor.setValue(at + nanovdb::Coord(v >> 6, v >> 3 & 7, v & 7), static_cast<float>(v + 1)),
                ++voxels;
    }
    const auto bytes = nanovdb_bytes(handles(builder.getHandle(1.0, nanovdb::Vec3d(0), "density")));
    const SparseGrid grid = NanovdbFile(bytes, "f").read("density").grid;
    EXPECT_LE(grid.block_count(), 2000u);
    EXPECT_GT(grid.block_count(), 1950u);
    EXPECT_LE(grid.blocks.size(), 512u * 4096);
    EXPECT_LT(grid.values.size() * 4 + grid.blocks.size() * 4 + grid.nodes.size() * 4, bytes.size());
}

// Whatever a file says, it is read or refused, and what was read can be looked up. A copied vector has memory of
// exactly its size, so that the address sanitizer sees every read beyond.
void expect_sound(const std::vector<std::uint8_t>& bytes) {
    try {
        const NanovdbFile file(bytes, "f");
        const PlacedSparseGrid read = file.read("density");
        ASSERT_TRUE(read.grid.is_consistent());
        ASSERT_LE(read.grid.values.size() + read.grid.blocks.size() + read.grid.nodes.size(), 20u << 20);
        float sum = read.grid.largest({0, 0, 0}, {1e9f, 1e9f, 1e9f});
        for (int n = 0; n < 300; ++n) {
            const auto x = static_cast<float>(n);
            sum += read.grid({x, 0.7f * x, 300 - x});
        }
        ASSERT_FALSE(std::isnan(sum));
        static_cast<void>(read.grid.non_zero());
    } catch (const Error&) {
    }
}

// Without checksums, which would hide the tree. Mostly in headers, offsets and masks.
TEST(NanovdbFile, DamagedBytesAreRefusedOrHarmless) {
    for (const auto codec : {nanovdb::io::Codec::NONE, nanovdb::io::Codec::ZIP}) {
        const auto good =
            nanovdb_bytes(handles(small_nanovdb("density", nanovdb::ChecksumMode::Disable,
                                                nanovdb::GridClass::FogVolume, 0, test::two_nodes)),
                          codec);
        ASSERT_EQ(error_of_file(good), "");
        const std::vector<std::size_t> vital = vital_places(good);
        const std::size_t head = std::min<std::size_t>(good.size(), 1400);
        std::mt19937 random(11);
        for (int n = 0; n < (under_sanitizers ? 400 : 1200); ++n) {
            auto bytes = good;
            for (unsigned k = 0; k <= random() % 3; ++k) {
                const std::size_t at = random() % 2 == 0 ? random() % head : vital[random() % vital.size()];
                bytes[at] = random() % 2 == 0 ? static_cast<std::uint8_t>(random())
                                              : static_cast<std::uint8_t>(bytes[at] ^ 1u << random() % 8);
            }
            expect_sound(bytes);
            if (HasFatalFailure()) FAIL() << n;
        }
        for (std::size_t n = 0; n < good.size(); n += n < 2000 ? (under_sanitizers ? 7 : 1) : 997)
            EXPECT_NE(error_of_file(std::vector(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(n))),
                      "")
                << n;
    }
}

// Each of the tree's offsets, to places that are wrong by a little, by a node or by far.
TEST(NanovdbFile, WrongOffsetsAreSeen) {
    const auto good = nanovdb_bytes(handles(small_nanovdb("density", nanovdb::ChecksumMode::Disable)));
    const std::size_t tree = 16 + 176 + 8 + 672, tile = tree + 64 + 64;
    const auto set = [&](std::size_t at, std::int64_t by) {
        auto bytes = good;
        std::int64_t value = 0;
        std::memcpy(&value, &bytes[at], 8);
        value += by;
        std::memcpy(&bytes[at], &value, 8);
        return error_of_file(bytes);
    };
    for (const std::int64_t by : {std::int64_t{32}, std::int64_t{-32}, std::int64_t{1} << 40,
                                  -(std::int64_t{1} << 40), std::numeric_limits<std::int64_t>::max() / 2}) {
        for (std::size_t i = 0; i < 4; ++i) EXPECT_NE(set(tree + 8 * i, by), "") << i << ' ' << by;
        EXPECT_NE(set(tile + 8, by), "") << by; // an upper node
    }
    // The child of the second tile instead of that of the first one: the place of another.
    EXPECT_EQ(set(tile + 8, sizeof(nanovdb::NanoUpper<float>)),
              "f.nvdb, grid 'density': the tree is damaged: two nodes share a child");
    // Places of nodes beyond the last one.
    for (const std::int64_t by : {8, 1000})
        EXPECT_EQ(set(tile + 8, by * std::int64_t{sizeof(nanovdb::NanoUpper<float>)}),
                  "f.nvdb, grid 'density': the tree is damaged: a node lies outside its place");
    // Two tiles at one place.
    auto bytes = good;
    std::copy_n(&good[tile], 8, &bytes[tile + 32]);
    EXPECT_EQ(error_of_file(bytes), "f.nvdb, grid 'density': the tree is damaged: two nodes at one place");
    // More leaves than the file holds.
    bytes = good;
    bytes[tree + 32 + 3] = 1;
    EXPECT_EQ(error_of_file(bytes),
              "f.nvdb, grid 'density': the tree is damaged: it has more nodes than the file holds");
}

// A few bytes must not ask for gigabytes.
TEST(NanovdbFile, SizesOutOfProportionAreRefused) {
    auto bytes = nanovdb_bytes(handles(small_nanovdb("density")), nanovdb::io::Codec::ZIP);
    const std::uint64_t size = std::uint64_t{1} << 40;
    std::memcpy(&bytes[16], &size, 8);
    EXPECT_NE(error_of_file(bytes).find("unpacks to 1048576 MiB, which is out of proportion"),
              std::string::npos);
}

} // namespace
} // namespace montelux
