// Pyramids in a file give the bits of those in memory.
#include "test/temporary_folder.h"
#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <memory>
#include <random>
#include <set>

#include "montelux/image/texel_file.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/scene/build/scene_builder.h"
#include "montelux/scene/scene_digest.h"
#include "montelux/scene/scene_tables.h"

namespace montelux {
namespace {

constexpr std::size_t least = TexelFile::least_limit;

Image random_image(int width, int height, std::vector<std::string> channels, PixelFormat format,
                   ColorEncoding encoding, std::mt19937& random) {
    Image image(width, height, std::move(channels), format, encoding);
    for (auto& v : image.u8()) v = static_cast<std::uint8_t>(random());
    for (auto& v : image.f32()) v = static_cast<float>(random() % 100000) / 70000;
    for (auto& v : image.u16())
        v = format == PixelFormat::f16 ? static_cast<std::uint16_t>(random() % 0x4000)
                                       : static_cast<std::uint16_t>(random());
    return image;
}

void expect_same_bits(const MipMap& a, const MipMap& b, std::mt19937& random) {
    std::uniform_real_distribution<float> place(-1.3f, 2.3f), log_size(-14, 1), sign(-1, 1);
    for (const TextureFilter filter :
         {TextureFilter::point, TextureFilter::bilinear, TextureFilter::trilinear, TextureFilter::ewa})
        for (const TextureWrap wrap :
             {TextureWrap::repeat, TextureWrap::black, TextureWrap::clamp, TextureWrap::octahedral_sphere})
            for (int i = 0; i < 60; ++i) {
                const float size = std::exp2(log_size(random));
                const Point2f st{place(random), place(random)};
                const Vec2f d0{size * sign(random), size * sign(random)},
                    d1{size * sign(random), size * sign(random)};
                const Vec3f x = a.lookup(st, d0, d1, filter, wrap, 8),
                            y = b.lookup(st, d0, d1, filter, wrap, 8);
                for (const auto& [p, q] : {std::pair{x.x, y.x}, {x.y, y.y}, {x.z, y.z}})
                    ASSERT_EQ(std::bit_cast<std::uint32_t>(p), std::bit_cast<std::uint32_t>(q))
                        << int(filter) << " " << int(wrap) << " at " << st.x << " " << st.y;
            }
}

TEST(MappedMipMap, BitsOfTheOneInMemory) {
    const TemporaryFolder folder;
    const auto file = TexelFile::create(least, folder.path());
    std::mt19937 random(1);
    const std::vector<std::vector<std::string>> channel_sets{
        {"Y"}, {"R", "G", "B"}, {"A", "B", "G", "R"}, {"R", "G", "B", "A"}, {"Y", "A"}};
    for (const auto& [w, h] : {std::pair{1, 1}, {1, 7}, {13, 1}, {37, 22}, {64, 64}, {257, 131}, {300, 5}})
        for (const PixelFormat format :
             {PixelFormat::u8, PixelFormat::u16, PixelFormat::f16, PixelFormat::f32})
            for (const auto& names : channel_sets)
                for (const ColorEncoding encoding : {ColorEncoding::linear(), ColorEncoding::srgb()}) {
                    Image image = random_image(w, h, names, format, encoding, random);
                    const Image in_memory = image;
                    image.move_to(*file);
                    const bool has_alpha = image.find_channel("A").has_value();
                    for (const ImageChannels channels : {ImageChannels::color, ImageChannels::alpha}) {
                        if (channels == ImageChannels::alpha && !has_alpha) continue;
                        SCOPED_TRACE(std::to_string(w) + " x " + std::to_string(h) + ", " +
                                     std::string(name_of(format)) + ", " + names[0] + ", alpha " +
                                     std::to_string(int(channels)));
                        const MipMap mapped(image, channels), plain(in_memory, channels);
                        EXPECT_EQ(mapped.bytes(), 0u);
                        EXPECT_EQ(mapped.is_color(), plain.is_color());
                        ASSERT_NO_FATAL_FAILURE(expect_same_bits(plain, mapped, random));
                    }
                }
    EXPECT_EQ(file->bytes(), 0u); // all blocks are gone
}

// For every format and shape: each texel has a place of its own, within the bytes, and a tile is no larger than
// what is made resident at once.
TEST(TileLayout, IsOneToOne) {
    for (const auto& [w, h] : {std::pair{1, 1}, {3, 1}, {1, 200}, {129, 70}, {333, 257}, {1024, 2}})
        for (const int stride : {1, 3})
            for (const PixelFormat format : {PixelFormat::u8, PixelFormat::f16, PixelFormat::f32}) {
                TexelLevel level{.format = format, .width = w, .height = h, .stride = stride};
                const std::size_t bytes = TileLayout::arrange(level);
                const std::size_t tile = TileLayout::tile_texels(level) * level.texel_bytes();
                EXPECT_LE(tile, TileLayout::most_bytes);
                EXPECT_EQ(bytes % tile, 0u);
                std::set<std::size_t> places;
                for (int y = 0; y < h; ++y)
                    for (int x = 0; x < w; ++x) places.insert(TileLayout::index(level, x, y));
                EXPECT_EQ(places.size(), static_cast<std::size_t>(w) * static_cast<std::size_t>(h));
                EXPECT_LT(*places.rbegin() * level.texel_bytes(), bytes);
            }
}

// The widest image: places beyond 2^31.
TEST(TileLayout, PlacesOfTheLargestImage) {
    TexelLevel level{.width = Image::max_dimension, .height = Image::max_dimension, .stride = 3};
    EXPECT_EQ(TileLayout::arrange(level), (std::size_t{1} << 32) * 12);
    EXPECT_EQ(TileLayout::index(level, Image::max_dimension - 1, Image::max_dimension - 1),
              (std::size_t{1} << 32) - 1);
}

TEST(MappedMipMap, TheDigestAndTheTablesDoNotDependOnIt) {
    const TemporaryFolder folder;
    std::mt19937 random(2);
    const Image large = random_image(300, 200, {"R", "G", "B", "A"}, PixelFormat::u8, ColorEncoding::srgb(),
                                     random),
                small = random_image(5, 4, {"Y"}, PixelFormat::f32, ColorEncoding::linear(), random);
    Scene scenes[2];
    scenes[1].texel_file = TexelFile::create(least, folder.path());
    for (Scene& scene : scenes) {
        CallMessages messages("a test");
        SceneBuilder builder(scene, messages);
        for (const Image* image : {&large, &small}) {
            ImageTexture t;
            t.image = builder.add_image(*image, "a picture");
            scene.float_textures.emplace_back(t);
        }
        ImageTexture alpha;
        alpha.image = 0;
        alpha.channels = ImageChannels::alpha;
        scene.float_textures.emplace_back(alpha);
    }
    EXPECT_EQ(digest_of(scenes[0]), digest_of(scenes[1]));
    EXPECT_TRUE(scenes[1].images[0].file());
    EXPECT_FALSE(scenes[1].images[1].file()) << "a small picture is not worth a page";

    const auto use_of = [](const std::vector<MemoryUse>& table, std::string_view kind) {
        for (const MemoryUse& use : table)
            if (use.kind == kind) return use;
        return MemoryUse{};
    };
    std::vector<std::unique_ptr<SceneTables>> tables;
    for (int i = 0; i < 2; ++i)
        with_threads(i == 0 ? 1 : 5, [&] { tables.push_back(std::make_unique<SceneTables>(scenes[i])); });
    EXPECT_EQ(scenes[1].texel_file->resident(), 0u) << "what was made is not read yet";
    for (Index i = 0; i < 2; ++i)
        expect_same_bits(tables[0]->view().mipmap(i, ImageChannels::color),
                         tables[1]->view().mipmap(i, ImageChannels::color), random);
    expect_same_bits(tables[0]->view().mipmap(0, ImageChannels::alpha),
                     tables[1]->view().mipmap(0, ImageChannels::alpha), random);
    EXPECT_EQ(use_of(memory_use(scenes[0]), "mapped textures").in_file, 0u);
    const MemoryUse mapped = use_of(memory_use(scenes[1]), "mapped textures");
    EXPECT_EQ(mapped.count, 1u);
    EXPECT_GT(mapped.in_file, large.byte_count() + 300u * 200 * (3 + 4));
    EXPECT_GT(mapped.bytes, 0u); // the look-ups above
    EXPECT_LE(mapped.bytes, mapped.in_file + 65536);
    EXPECT_EQ(use_of(memory_use(scenes[1]), "images").bytes, small.byte_count());
    EXPECT_LT(use_of(tables[1]->memory_use(), "pyramids of images").bytes, 10000u);
}

} // namespace
} // namespace montelux
