#include "test/image/image_testing.h"
#include "test/image/ktx2_reading.h"
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "montelux/image/half.h"
#include "montelux/image/ktx2_write.h"

namespace montelux {
namespace {

constexpr TexelFormat all_formats[] = {TexelFormat::rgba16f, TexelFormat::rgba32f, TexelFormat::rg16f,
                                       TexelFormat::rg32f,   TexelFormat::rgb9e5,  TexelFormat::r11g11b10f,
                                       TexelFormat::rgbm8};

// Positive light over ten stops, other in every texel.
// What the format stores differs from v by at most this.
double tolerance(TexelFormat format, double v, const Texel& texel) {
    const double most = std::max({texel.v[0], texel.v[1], texel.v[2]});
    switch (format) {
    case TexelFormat::rgba32f:
    case TexelFormat::rg32f:
        return 0;
    case TexelFormat::rgba16f:
    case TexelFormat::rg16f:
        return v * 0x1p-11;
    case TexelFormat::r11g11b10f:
        return v * 0x1p-6;
    case TexelFormat::rgb9e5:
        return most * 0x1p-9;
    case TexelFormat::rgbm8:
        break;
    }
    return 16 * texel.v[3] * 0.5 / 255 * (1 + 1e-6);
}

TEST(Ktx2, CubeChainsAreReadBackInEveryFormat) {
    TemporaryFolder folder;
    for (TexelFormat format : all_formats)
        for (const auto& [size, levels] : {std::pair{1, 1}, {8, 4}, {8, 2}, {5, 3}, {6, 3}, {3, 2}}) {
            SCOPED_TRACE(std::string(name_of(format)) + " " + std::to_string(size));
            const CubeMapChain chain = chain_of_noise(size, levels);
            TextureOptions options{.format = format, .notes = {{"montelux.roughness", "0 0.5 1"}}};
            EXPECT_FALSE(write_ktx2(folder / "a.ktx2", chain, options).any());
            const Ktx2Contents file = read_ktx2(read_bytes(folder / "a.ktx2"));
            ASSERT_EQ(file.faces, 6u);
            ASSERT_EQ(file.width, static_cast<unsigned>(size));
            ASSERT_EQ(file.levels.size(), static_cast<std::size_t>(levels));
            EXPECT_EQ(file.notes.at("KTXorientation"), "rd");
            EXPECT_EQ(file.notes.at("KTXwriter").substr(0, 9), "Montelux ");
            EXPECT_EQ(file.notes.at("montelux.roughness"), "0 0.5 1");
            const bool table = format == TexelFormat::rg16f || format == TexelFormat::rg32f;
            EXPECT_EQ(file.color_primaries, table ? 0u : 1u);
            for (int level = 0; level < levels; ++level)
                for (int face = 0; face < cube_faces; ++face)
                    for (int y = 0; y < level_size(size, level); ++y)
                        for (int x = 0; x < level_size(size, level); ++x) {
                            const Texel t = ktx2_texel(file, level, face, x, y);
                            for (int c = 0; c < (table ? 2 : 3); ++c) {
                                const double v = chain.levels[level].faces[face].value(x, y, c);
                                const double m = format == TexelFormat::rgbm8 ? 16 * t.v[3] : 1;
                                ASSERT_NEAR(t.v[c] * m, v, tolerance(format, v, t));
                            }
                            if (format != TexelFormat::rgbm8) {
                                ASSERT_EQ(t.v[3], 1);
                            }
                        }
        }
}

TEST(Ktx2, PicturesAreReadBack) {
    TemporaryFolder folder;
    Image table(7, 3, {"R", "G", "B"});
    for (std::size_t i = 0; i < table.sample_count(); ++i) table.f32()[i] = static_cast<float>(noise(i));
    write_ktx2(folder / "table.ktx2", table, {.format = TexelFormat::rg32f});
    const Ktx2Contents file = read_ktx2(read_bytes(folder / "table.ktx2"));
    EXPECT_EQ(file.faces, 1u);
    EXPECT_EQ(file.width, 7u);
    EXPECT_EQ(file.height, 3u);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 7; ++x)
            for (int c = 0; c < 2; ++c) EXPECT_EQ(ktx2_texel(file, 0, 0, x, y).v[c], table.value(x, y, c));

    // Grey becomes R = G = B, alpha stays, and 8 bits are decoded to linear light.
    Image grey(2, 1, {"Y", "A"}, PixelFormat::u8, ColorEncoding::srgb());
    grey.u8()[0] = 188;
    grey.u8()[1] = 128;
    write_ktx2(folder / "grey.ktx2", grey, {.format = TexelFormat::rgba32f});
    const Texel t = ktx2_texel(read_ktx2(read_bytes(folder / "grey.ktx2")), 0, 0, 0, 0);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(t.v[c], srgb_to_linear(188.0f / 255));
    EXPECT_EQ(t.v[3], 128.0f / 255);
}

TEST(Ktx2, TheRangeOfRgbmIsNoted) {
    TemporaryFolder folder;
    write_ktx2(folder / "a.ktx2", chain_of_noise(2, 1), {.format = TexelFormat::rgbm8, .rgbm = {6.5, 2}});
    const Ktx2Contents file = read_ktx2(read_bytes(folder / "a.ktx2"));
    EXPECT_EQ(file.notes.at("montelux.rgbm.range"), "6.5");
    EXPECT_EQ(file.notes.at("montelux.rgbm.power"), "2");
    write_ktx2(folder / "b.ktx2", chain_of_noise(2, 1), {});
    EXPECT_EQ(read_ktx2(read_bytes(folder / "b.ktx2")).notes.size(), 2u);
}

TEST(Ktx2, WhatDoesNotFitIsCounted) {
    TemporaryFolder folder;
    CubeMapChain chain{{make_cube_map(2)}};
    chain.levels[0].faces[3].set(1, 1, 0, 1e6f);
    chain.levels[0].faces[3].set(1, 1, 1, -2);
    chain.levels[0].faces[3].set(1, 1, 2, std::numeric_limits<float>::quiet_NaN());
    TexelLosses losses = write_ktx2(folder / "a.ktx2", chain, {});
    EXPECT_EQ(losses.too_large, 1u);
    EXPECT_EQ(losses.largest, 1e6f);
    EXPECT_EQ(losses.negative, 0u); // a half has a sign
    EXPECT_EQ(losses.not_number, 1u);
    const Texel t = ktx2_texel(read_ktx2(read_bytes(folder / "a.ktx2")), 0, 3, 1, 1);
    EXPECT_EQ(t.v[0], 65504);
    EXPECT_EQ(t.v[1], -2);
    EXPECT_EQ(t.v[2], 0);
    EXPECT_EQ(write_ktx2(folder / "a.ktx2", chain, {.format = TexelFormat::rgb9e5}).negative, 1u);
}

TEST(Ktx2, BadInputGivesASentenceAndNoFile) {
    TemporaryFolder folder;
    const CubeMapChain good = chain_of_noise(4, 2);
    const auto path = folder / "a.ktx2";
    expect_error([&] { write_ktx2(path, CubeMapChain{}, {}); }, {"a.ktx2", "no level"});
    CubeMapChain odd = good;
    odd.levels[1] = make_cube_map(3);
    expect_error([&] { write_ktx2(path, odd, {}); }, {"a.ktx2", "level 1 has size 3", "expected 2"});
    expect_error([&] { write_ktx2(path, Image(), {}); }, {"a.ktx2", "no pixels"});
    expect_error([&] { write_ktx2(path, Image(2, 2, {"depth"}), {}); }, {"a.ktx2", "neither", "R, G, B"});
    expect_error([&] { write_ktx2(path, Image(2, 2, {"Y"}), {.format = TexelFormat::rg16f}); },
                 {"a.ktx2", "lacks the channels R and G"});
    for (const RgbmScale& scale : {RgbmScale{0, 1}, RgbmScale{std::nan(""), 1}, RgbmScale{1e9, 1}})
        expect_error([&] { write_ktx2(path, good, {.format = TexelFormat::rgbm8, .rgbm = scale}); },
                     {"a.ktx2", "range of RGBM", "expected 1 to 65536"});
    expect_error([&] { write_ktx2(path, good, {.rgbm = {16, 3}}); }, {"power of RGBM is 3"});
    expect_error(
        [&] {
            write_ktx2(path, good, {.notes = {{"ktxA", ""}}});
        },
        {"'ktxA'", "keep for themselves"});
    expect_error([&] { write_ktx2(path, good, {.notes = {{"", ""}}}); }, {"empty key"});
    expect_error([&] { write_ktx2(path, good, {.notes = {{"a", std::string(1, '\0')}}}); }, {"zero byte"});
    EXPECT_EQ(folder.file_count(), 0);
    expect_error([&] { write_ktx2(folder / "none/a.ktx2", good, {}); }, {"none/a.ktx2"});
}

TEST(Ktx2, TheReaderOfTheTestsSeesDamage) {
    TemporaryFolder folder;
    write_ktx2(folder / "a.ktx2", chain_of_noise(5, 3), {.notes = {{"montelux.x", "y"}}});
    const std::string good = read_bytes(folder / "a.ktx2");
    const std::size_t data_at = read_ktx2(good).levels.size() * 24 + 80 + 92 + 40;
    int missed = 0;
    for (std::size_t i = 0; i < data_at; ++i) {
        std::string bad = good;
        bad[i] = static_cast<char>(bad[i] ^ 0x10);
        try {
            const Ktx2Contents file = read_ktx2(bad);
            ++missed; // a letter of a note, no more
        } catch (const std::runtime_error&) {
        }
    }
    EXPECT_LE(missed, 45);
}

} // namespace
} // namespace montelux
