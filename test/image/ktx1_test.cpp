#include "test/image/image_testing.h"
#include "test/image/ktx2_reading.h"
#include "test/image/word_at.h"
#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>

#include "montelux/image/ktx1_write.h"

namespace montelux {
namespace {

TEST(Ktx1, EveryFieldIsAsTheSpecificationSays) {
    TemporaryFolder folder;
    for (bool half : {true, false}) {
        constexpr int size = 5;
        CubeMapChain chain;
        for (int level = 0; level < 3; ++level) {
            chain.levels.push_back(make_cube_map(level_size(size, level)));
            for (int f = 0; f < cube_faces; ++f)
                for (float& v : chain.levels[level].faces[f].f32())
                    v = static_cast<float>(10 * level + f) + 0.25f;
        }
        const std::string sh = "1 2 3\n4 5 6\n";
        write_ktx1(folder / "a.ktx", chain,
                   {.format = half ? TexelFormat::rgba16f : TexelFormat::rgba32f, .notes = {{"sh", sh}}});
        const std::string file = read_bytes(folder / "a.ktx");
        EXPECT_EQ(file.substr(0, 12), "\xABKTX 11\xBB\r\n\x1A\n");
        const std::uint32_t notes_bytes = testing::word_at(file, 60);
        const std::uint32_t expected[] = {0x04030201,
                                          half ? 0x140bu : 0x1406u,
                                          half ? 2u : 4u,
                                          0x1908,
                                          half ? 0x881au : 0x8814u,
                                          0x1908,
                                          size,
                                          size,
                                          0,
                                          0,
                                          6,
                                          3};
        for (std::size_t i = 0; i < std::size(expected); ++i)
            EXPECT_EQ(testing::word_at(file, 12 + 4 * i), expected[i]) << i;

        std::map<std::string, std::string> notes;
        std::size_t at = 64;
        while (at < 64 + notes_bytes) {
            const std::string pair = file.substr(at + 4, testing::word_at(file, at));
            const std::size_t zero = pair.find('\0');
            notes[pair.substr(0, zero)] = pair.substr(zero + 1);
            at += 4 + (pair.size() + 3) / 4 * 4;
        }
        ASSERT_EQ(at, 64 + notes_bytes);
        EXPECT_EQ(notes.at("sh"), sh + '\0');
        EXPECT_EQ(notes.at("KTXorientation"), std::string("S=r,T=d") + '\0');

        const std::size_t texel = half ? 8 : 16;
        for (int level = 0; level < 3; ++level) {
            const std::size_t n = level_size(size, level), face_bytes = n * n * texel;
            ASSERT_EQ(testing::word_at(file, at), face_bytes);
            at += 4;
            for (int f = 0; f < cube_faces; ++f)
                for (std::size_t i = 0; i < n * n; ++i, at += texel)
                    for (std::size_t c = 0; c < 4; ++c) {
                        float v = 0;
                        const std::uint32_t bits = testing::word_at(file, at + c * texel / 4);
                        std::memcpy(&v, &bits, sizeof v);
                        if (half) v = static_cast<float>(decode_half(bits & 0xffffu));
                        ASSERT_EQ(v, c == 3 ? 1 : static_cast<float>(10 * level + f) + 0.25f);
                    }
        }
        EXPECT_EQ(at, file.size());
    }
}

TEST(Ktx1, OtherFormatsAreRefused) {
    TemporaryFolder folder;
    expect_error([&] { write_ktx1(folder / "a.ktx", {{make_cube_map(1)}}, {.format = TexelFormat::rgb9e5}); },
                 {"a.ktx", "rgba16f or rgba32f", "rgb9e5"});
    expect_error([&] { write_ktx1(folder / "a.ktx", {}, {}); }, {"a.ktx", "no level"});
    EXPECT_EQ(folder.file_count(), 0);
}

} // namespace
} // namespace montelux
