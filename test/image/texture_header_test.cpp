#include "test/image/image_testing.h"

#include "montelux/image/dds_write.h"
#include "montelux/image/ktx1_write.h"
#include "montelux/image/ktx2_write.h"
#include "montelux/image/texture_header.h"
#include "montelux/mc/io/file.h"

namespace montelux {
namespace {

using Write = TexelLosses (*)(const std::filesystem::path&, const CubeMapChain&, const TextureOptions&);

std::vector<std::uint8_t> bytes_of(Write write, const char* name, const TextureOptions& options = {}) {
    TemporaryFolder folder;
    write(folder / name, chain_of_noise(8, 3), options);
    return read_file_bytes(folder / name, 1 << 20);
}

TEST(TextureHeader, SaysWhatTheWritersWrote) {
    TextureOptions with_notes;
    with_notes.notes = {{"montelux.roughness", "0 0.5 1"}};
    const auto ktx2 = texture_header(bytes_of(write_ktx2, "a.ktx2", with_notes), "a");
    ASSERT_TRUE(ktx2);
    EXPECT_EQ(ktx2->container, "KTX 2.0");
    EXPECT_EQ(ktx2->format, "R16G16B16A16_SFLOAT");
    EXPECT_EQ(ktx2->width, 8u);
    EXPECT_EQ(ktx2->height, 8u);
    EXPECT_EQ(ktx2->levels, 3u);
    EXPECT_EQ(ktx2->faces, 6u);
    EXPECT_EQ(ktx2->layers, 1u);
    EXPECT_EQ(ktx2->level_bytes, (std::vector<std::uint64_t>{8 * 8 * 6 * 8, 4 * 4 * 6 * 8, 2 * 2 * 6 * 8}));
    EXPECT_EQ(ktx2->notes.at("montelux.roughness"), "0 0.5 1");

    TextureOptions floats = with_notes;
    floats.format = TexelFormat::rgba32f;
    const auto ktx1 = texture_header(bytes_of(write_ktx1, "a.ktx", floats), "a");
    ASSERT_TRUE(ktx1);
    EXPECT_EQ(ktx1->format, "GL_RGBA32F");
    EXPECT_EQ(ktx1->levels, 3u);
    EXPECT_EQ(ktx1->faces, 6u);
    EXPECT_EQ(ktx1->notes.at("montelux.roughness"), "0 0.5 1");

    const auto dds = texture_header(bytes_of(write_dds, "a.dds"), "a");
    ASSERT_TRUE(dds);
    EXPECT_EQ(dds->width, 8u);
    EXPECT_EQ(dds->levels, 3u);
    EXPECT_EQ(dds->faces, 6u);
    EXPECT_NE(dds->format.find("16"), std::string::npos);

    EXPECT_FALSE(texture_header(std::vector<std::uint8_t>{'P', 'F', '\n'}, "a"));
}

// Cut anywhere, or with any one byte of the header changed: a sentence or a header, never more.
TEST(TextureHeader, DamagedFilesGiveASentence) {
    for (const auto& whole :
         {bytes_of(write_ktx2, "a.ktx2"), bytes_of(write_ktx1, "a.ktx"), bytes_of(write_dds, "a.dds")}) {
        int refused = 0;
        for (std::size_t size = 12; size < 200; ++size) try {
                texture_header(std::span(whole).first(size), "cut");
            } catch (const Error& e) {
                EXPECT_NE(std::string(e.what()).find("cut"), std::string::npos);
                ++refused;
            }
        EXPECT_GT(refused, 20);
        for (std::size_t at = 12; at < 160; ++at)
            for (const int change : {0x01, 0x80, 0xff}) {
                auto damaged = whole;
                damaged[at] ^= static_cast<std::uint8_t>(change);
                try {
                    texture_header(damaged, "damaged");
                } catch (const Error&) {
                }
            }
    }
}

} // namespace
} // namespace montelux
