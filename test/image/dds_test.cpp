#include "test/image/image_testing.h"
#include "test/image/ktx2_reading.h"
#include "test/image/word_at.h"
#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>

#include "montelux/image/dds_write.h"

namespace montelux {
namespace {

TEST(Dds, EveryFieldIsAsTheReferenceSays) {
    TemporaryFolder folder;
    for (bool half : {true, false})
        for (int levels : {1, 3}) {
            constexpr int size = 6;
            CubeMapChain chain;
            for (int level = 0; level < levels; ++level) {
                chain.levels.push_back(make_cube_map(level_size(size, level)));
                for (int f = 0; f < cube_faces; ++f) {
                    Image& face = chain.levels[level].faces[f];
                    for (int y = 0; y < face.height(); ++y)
                        for (int x = 0; x < face.width(); ++x)
                            for (int c = 0; c < 3; ++c)
                                face.set(x, y, c,
                                         static_cast<float>(100 * level + 10 * f + c) + 0.125f * (x + 2 * y));
                }
            }
            write_dds(folder / "a.dds", chain,
                      {.format = half ? TexelFormat::rgba16f : TexelFormat::rgba32f});
            const std::string file = read_bytes(folder / "a.dds");
            EXPECT_EQ(file.substr(0, 4), "DDS ");
            std::map<std::size_t, std::uint32_t> expected{{4, 124},
                                                          {8, 0x2100f},
                                                          {12, size},
                                                          {16, size},
                                                          {20, size * (half ? 8u : 16u)},
                                                          {28, levels},
                                                          {76, 32},
                                                          {80, 4},
                                                          {84, half ? 113u : 116u},
                                                          {88, half ? 64u : 128u},
                                                          {108, levels > 1 ? 0x401008u : 0x1008u},
                                                          {112, 0xfe00}};
            for (std::size_t at = 4; at < 128; at += 4)
                EXPECT_EQ(testing::word_at(file, at), expected.contains(at) ? expected[at] : 0) << at;

            const std::size_t texel = half ? 8 : 16;
            std::size_t at = 128;
            for (int f = 0; f < cube_faces; ++f)
                for (int level = 0; level < levels; ++level)
                    for (int y = 0; y < level_size(size, level); ++y)
                        for (int x = 0; x < level_size(size, level); ++x, at += texel)
                            for (std::size_t c = 0; c < 4; ++c) {
                                float v = 0;
                                const std::uint32_t bits = testing::word_at(file, at + c * texel / 4);
                                std::memcpy(&v, &bits, sizeof v);
                                if (half) v = static_cast<float>(decode_half(bits & 0xffffu));
                                ASSERT_EQ(v, c == 3 ? 1
                                                    : chain.levels[level].faces[f].value(
                                                          x, y, static_cast<int>(c)));
                            }
            EXPECT_EQ(at, file.size());
        }
}

TEST(Dds, WhatItCannotHoldIsRefused) {
    TemporaryFolder folder;
    const CubeMapChain chain{{make_cube_map(1)}};
    expect_error([&] { write_dds(folder / "a.dds", chain, {.format = TexelFormat::rgbm8}); },
                 {"a.dds", "rgba16f or rgba32f", "rgbm8"});
    expect_error([&] { write_dds(folder / "a.dds", chain, {.notes = {{"sh", "1"}}}); }, {"no notes", "'sh'"});
    expect_error([&] { write_dds(folder / "a.dds", {}, {}); }, {"a.dds", "no level"});
    EXPECT_EQ(folder.file_count(), 0);
}

} // namespace
} // namespace montelux
