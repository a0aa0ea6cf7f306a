#include "test/image/image_testing.h"
#include <cmath>
#include <limits>

#include "montelux/image/half.h"
#include "montelux/image/image_read.h"
#include "montelux/image/image_write.h"
#include "montelux/image/placement.h"

namespace montelux {
namespace {

TEST(ExrFile, KeepsEveryBitOfEveryChannel) {
    TemporaryFolder folder;
    Image image = make_picture(37, 41, {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B", "depth"});
    image.set(3, 4, 0, std::numeric_limits<float>::infinity());
    image.set(4, 4, 0, std::numeric_limits<float>::quiet_NaN());
    image.set(5, 4, 0, std::numeric_limits<float>::denorm_min());
    for (ExrCompression compression : {ExrCompression::uncompressed, ExrCompression::rle,
                                       ExrCompression::zips, ExrCompression::zip, ExrCompression::piz}) {
        write_image(folder / "a.exr", image, {.exr_compression = compression});
        Image back = read_image(folder / "a.exr");
        ASSERT_EQ(back.width(), 37);
        ASSERT_EQ(back.height(), 41);
        EXPECT_EQ(back.format(), PixelFormat::f32);
        Image same_order = back.select(image.channel_names());
        EXPECT_TRUE(same_bits(same_order.f32(), image.f32())) << static_cast<int>(compression);
        // Colour first, whatever the alphabet says.
        EXPECT_EQ(back.channel_names()[0], "R");
        EXPECT_EQ(back.channel_names()[2], "B");
        EXPECT_EQ(back.color_channels("stderr.").size(), 3u);
    }
}

// Chosen channels are rounded to 16 bits, to nearest even, and the others keep theirs.
TEST(ExrFile, RoundsChosenChannelsToHalfs) {
    TemporaryFolder folder;
    Image image = make_picture(19, 23, {"R", "G", "depth.Z"});
    const float infinity = std::numeric_limits<float>::infinity();
    struct Rounding {
        float from, to;
    };
    // 11 bits of mantissa: 1 + 2^-11 lies in the middle and goes to the even neighbour, as 1 + 3 * 2^-11 does.
    const Rounding roundings[] = {{1 + 0x1p-11f, 1},
                                  {1 + 3 * 0x1p-11f, 1 + 0x1p-9f},
                                  {1 + 0x1.002p-11f, 1 + 0x1p-10f},
                                  {-2049, -2048},
                                  {0x1p-25f, 0},
                                  {0x1.8p-24f, 0x1p-23f},
                                  {65504, 65504},
                                  {65519, 65504},
                                  {65520, 65504},
                                  {-1e30f, -65504},
                                  {infinity, infinity}};
    for (std::size_t i = 0; i < std::size(roundings); ++i)
        for (int c = 0; c < 3; ++c) image.set(static_cast<int>(i), 2, c, roundings[i].from);
    image.set(12, 2, 0, std::numeric_limits<float>::quiet_NaN());
    const std::vector<std::string> halves{"R", "missing", "R"};
    EXPECT_EQ(half_overflows(cut_out(image, {7, 2, 11, 3}), {"R", "missing"}), 3u);
    write_image(folder / "a.exr", image, {.exr_half = halves});
    const Image back = read_image(folder / "a.exr");
    EXPECT_EQ(back.format(), PixelFormat::f32); // not all are halfs
    const int r = *back.find_channel("R"), g = *back.find_channel("G"), z = *back.find_channel("depth.Z");
    for (std::size_t i = 0; i < std::size(roundings); ++i) {
        const int x = static_cast<int>(i);
        EXPECT_EQ(back.value(x, 2, r), roundings[i].to) << roundings[i].from;
        EXPECT_EQ(back.value(x, 2, g), roundings[i].from);
        EXPECT_EQ(back.value(x, 2, z), roundings[i].from);
    }
    EXPECT_TRUE(std::isnan(back.value(12, 2, r)));
    for (int x = 0; x < 19; ++x)
        EXPECT_EQ(back.value(x, 7, r), half_to_float(float_to_half(image.value(x, 7, 0))));
    write_image(folder / "b.exr", image, {.exr_half = {"R", "G", "depth.Z"}});
    const Image all = read_image(folder / "b.exr");
    EXPECT_EQ(all.format(), PixelFormat::f16);
    for (const char* name : {"R", "G", "depth.Z"})
        for (int x = 0; x < 19; ++x)
            EXPECT_EQ(all.value(x, 7, *all.find_channel(name)),
                      half_to_float(clamped_half(image.value(x, 7, *image.find_channel(name)))));
}

TEST(ExrFile, KeepsAttributes) {
    TemporaryFolder folder;
    Image image = make_picture(5, 3, {"R", "G", "B"});
    Matrix4 m;
    for (int i = 0; i < 16; ++i) m.m[i / 4][i % 4] = i * 0.25 - 1;
    Attributes& a = image.attributes();
    a["comments"] = std::string("a sentence");
    a["samplesPerPixel"] = 64;
    a["exposure"] = 0.5f;
    a["seconds"] = 1.0 / 3;
    a["worldToCamera"] = m;
    a["chromaticities"] = std::vector<float>{0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
    a["two"] = std::vector<float>{1, 2};
    a["three"] = std::vector<float>{1, 2, 3};
    a["many"] = std::vector<float>{1, 2, 3, 4, 5};
    a["dataWindow.x"] = -7;
    a["dataWindow.y"] = 11;
    write_image(folder / "a.exr", image);
    Image back = read_image(folder / "a.exr");
    for (const auto& [key, value] : a) {
        ASSERT_TRUE(back.attributes().contains(key)) << key;
        EXPECT_TRUE(back.attributes().at(key) == value) << key;
    }
    EXPECT_TRUE(same_bits(back.f32(), image.f32()));
}

// The flag of long names raises the limit from 31 to 255 characters; the flag of tiles does not.
TEST(ExrFile, NamesAreAsLongAsTheFileSaysTheyMayBe) {
    TemporaryFolder folder;
    const std::string name(255, 'x');
    const Image image = make_picture(5, 3, {"R", "G", "B", name});
    write_image(folder / "a.exr", image);
    const Image back = read_image(folder / "a.exr").select(image.channel_names());
    EXPECT_TRUE(same_bits(back.f32(), image.f32()));
    // Bits 9 and 10 of the version are those of tiles and of long names.
    std::string bytes = read_bytes(folder / "a.exr");
    ASSERT_EQ(bytes[5], '\x04');
    for (const char flags : {'\x00', '\x02'}) {
        bytes[5] = flags;
        write_bytes(folder / "b.exr", bytes);
        expect_error([&] { read_image(folder / "b.exr"); }, {"a channel name is longer than 31"});
    }
}

TEST(ExrFile, MatrixIsStoredForRowVectors) {
    TemporaryFolder folder;
    Image image = make_picture(1, 1, {"Y"});
    image.attributes()["m"] = Transform::translate({2, 3, 4}).matrix();
    write_image(folder / "a.exr", image, {.exr_compression = ExrCompression::uncompressed});
    std::string bytes = read_bytes(folder / "a.exr");
    auto at = bytes.find(std::string("m\0m44f\0", 7));
    ASSERT_NE(at, std::string::npos);
    float stored[16];
    std::memcpy(stored, bytes.data() + at + 11, sizeof stored);
    EXPECT_EQ(stored[12], 2);
    EXPECT_EQ(stored[13], 3);
    EXPECT_EQ(stored[14], 4);
}

TEST(ExrFile, HalfStaysHalf) {
    TemporaryFolder folder;
    Image image(64, 16, {"R", "G", "B"}, PixelFormat::f16);
    for (std::size_t i = 0; i < image.sample_count(); ++i)
        image.u16()[i] = static_cast<std::uint16_t>(i * 21);
    write_image(folder / "a.exr", image);
    Image back = read_image(folder / "a.exr");
    ASSERT_EQ(back.format(), PixelFormat::f16);
    EXPECT_TRUE(std::equal(back.u16().begin(), back.u16().end(), image.u16().begin()));
}

TEST(PfmFile, KeepsEveryBit) {
    TemporaryFolder folder;
    for (const auto& channels : {std::vector<std::string>{"R", "G", "B"}, std::vector<std::string>{"Y"}}) {
        Image image = make_picture(9, 7, channels);
        write_image(folder / "a.pfm", image);
        Image back = read_image(folder / "a.pfm");
        EXPECT_EQ(back.channel_names(), channels);
        EXPECT_TRUE(same_bits(back.f32(), image.f32()));
    }
}

TEST(PfmFile, ReadsBothByteOrdersAndTheScale) {
    TemporaryFolder folder;
    // 1 x 2 grey: bottom row 1.0, top row 2.0.
    write_bytes(folder / "big.pfm", std::string("Pf\n1 2\n3.0\n\x3f\x80\0\0\x40\0\0\0", 19));
    Image big = read_image(folder / "big.pfm");
    EXPECT_EQ(big.value(0, 0, 0), 6);
    EXPECT_EQ(big.value(0, 1, 0), 3);
    write_bytes(folder / "little.pfm", std::string("Pf\n1 2\n-1.0\n\0\0\x80\x3f\0\0\0\x40", 20));
    Image little = read_image(folder / "little.pfm");
    EXPECT_EQ(little.value(0, 0, 0), 2);
    EXPECT_EQ(little.value(0, 1, 0), 1);
    write_bytes(folder / "short.pfm", std::string("Pf\n1 2\n-1.0\n\0\0\x80\x3f\0\0\0", 19));
    expect_error([&] { read_image(folder / "short.pfm"); }, {"short.pfm", "7 bytes", "8"});
}

TEST(HdrFile, RoundsToAnEightBitMantissa) {
    TemporaryFolder folder;
    for (int width : {3, 8, 300}) { // plain pixels, and runs
        Image image(width, 5, {"R", "G", "B"});
        for (std::size_t i = 0; i < image.sample_count(); ++i)
            image.f32()[i] = static_cast<float>(noise(i / 9) * std::exp2(30 * (noise(i / 27 + 1000) - 0.5)));
        write_image(folder / "a.hdr", image);
        Image back = read_image(folder / "a.hdr");
        ASSERT_EQ(back.width(), width);
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < width; ++x) {
                float largest = std::max({image.value(x, y, 0), image.value(x, y, 1), image.value(x, y, 2)});
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(back.value(x, y, c), image.value(x, y, c), largest / 255.0f);
            }
    }
}

TEST(HdrFile, HostileValuesAreClamped) {
    TemporaryFolder folder;
    Image image(2, 1, {"R", "G", "B"});
    image.set(0, 0, 0, std::numeric_limits<float>::infinity());
    image.set(0, 0, 1, std::numeric_limits<float>::quiet_NaN());
    image.set(0, 0, 2, -5);
    write_image(folder / "a.hdr", image);
    Image back = read_image(folder / "a.hdr");
    EXPECT_GT(back.value(0, 0, 0), 1e38f);
    EXPECT_EQ(back.value(0, 0, 1), 0);
    EXPECT_EQ(back.value(0, 0, 2), 0);
}

TEST(PngFile, KeepsEightAndSixteenBitCodes) {
    TemporaryFolder folder;
    for (const auto& channels :
         {std::vector<std::string>{"Y"}, std::vector<std::string>{"Y", "A"},
          std::vector<std::string>{"R", "G", "B"}, std::vector<std::string>{"R", "G", "B", "A"}}) {
        Image image(16, 16, channels, PixelFormat::u8, ColorEncoding::srgb());
        for (std::size_t i = 0; i < image.sample_count(); ++i)
            image.u8()[i] = static_cast<std::uint8_t>(i * 7);
        write_image(folder / "a.png", image);
        Image back = read_image(folder / "a.png");
        EXPECT_EQ(back.channel_names(), channels);
        EXPECT_EQ(back.encoding(), ColorEncoding::srgb());
        EXPECT_TRUE(std::equal(back.u8().begin(), back.u8().end(), image.u8().begin(), image.u8().end()));
        // The same codes come back when the light goes through floats.
        write_image(folder / "b.png", image.to_linear_f32());
        Image through = read_image(folder / "b.png");
        EXPECT_TRUE(std::equal(through.u8().begin(), through.u8().end(), image.u8().begin()));
    }
    Image light(256, 1, {"R", "G", "B"});
    for (std::size_t i = 0; i < light.sample_count(); ++i) light.f32()[i] = static_cast<float>(noise(i));
    write_image(folder / "c.png", light, {.png_bits = 16});
    Image wide = read_image(folder / "c.png");
    ASSERT_EQ(wide.format(), PixelFormat::u16);
    for (int x = 0; x < 256; ++x) EXPECT_NEAR(wide.linear(x, 0, 1), light.value(x, 0, 1), 2e-5);
    write_image(folder / "d.png", light, {.tone = {.exposure = -1}});
    Image dark = read_image(folder / "d.png");
    for (int x = 0; x < 256; ++x) EXPECT_NEAR(dark.linear(x, 0, 1), light.value(x, 0, 1) / 2, 0.005);
}

TEST(JpegFile, ComesBackWithinItsQuality) {
    TemporaryFolder folder;
    Image image(70, 40, {"R", "G", "B", "A"}, PixelFormat::u8, ColorEncoding::srgb());
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 70; ++x) {
            const int codes[] = {3 * x, 6 * y, x < 35 ? 40 : 220, 128};
            for (int c = 0; c < 4; ++c)
                image.u8()[image.index(x, y, c)] = static_cast<std::uint8_t>(codes[c]);
        }
    const auto largest_difference = [&](const char* name, int quality) {
        write_image(folder / name, image, {.jpeg_quality = quality});
        const Image back = read_image(folder / name);
        EXPECT_EQ(back.channel_names(), (std::vector<std::string>{"R", "G", "B"})); // without alpha
        int most = 0;
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 70; ++x)
                for (int c = 0; c < 3; ++c)
                    most = std::max(
                        most, std::abs(back.u8()[back.index(x, y, c)] - image.u8()[image.index(x, y, c)]));
        return most;
    };
    EXPECT_LE(largest_difference("a.jpg", 100), 4);
    EXPECT_LE(largest_difference("b.JPEG", 95), 12);
    EXPECT_GT(largest_difference("c.jpg", 5), 12);
    EXPECT_LT(std::filesystem::file_size(folder / "c.jpg"), std::filesystem::file_size(folder / "a.jpg"));

    Image grey(9, 5, {"Y"});
    for (int x = 0; x < 9; ++x) grey.set(x, 0, 0, 0.25f);
    write_image(folder / "grey.jpg", grey, {.tone = {.exposure = 1}});
    const Image back = read_image(folder / "grey.jpg");
    EXPECT_EQ(back.channel_names(), std::vector<std::string>{"Y"});
    EXPECT_NEAR(back.u8()[4], 188, 2); // 255 * srgb(0.5)
}

TEST(PngFile, LinearCodesSaySo) {
    TemporaryFolder folder;
    Image image(1, 1, {"Y"});
    image.set(0, 0, 0, 0.5f);
    write_image(folder / "a.png", image, {.tone = {.kind = ToneKind::linear}});
    const Image back = read_image(folder / "a.png");
    EXPECT_EQ(back.u8()[0], 128);
    ASSERT_TRUE(back.attributes().contains("png.gamma"));
    EXPECT_EQ(std::get<float>(back.attributes().at("png.gamma")), 1);
}

TEST(ImageWrite, RefusesWhatItCannotWrite) {
    TemporaryFolder folder;
    Image image = make_picture(4, 4, {"depth"});
    expect_error([&] { write_image(folder / "a.gif", image); },
                 {"a.gif", "'.gif'", ".exr, .png, .jpg, .hdr, .pfm"});
    expect_error([&] { write_image(folder / "a.jpg", image); }, {"a.jpg", "R, G, B", "depth"});
    expect_error([&] { write_image(folder / "a.png", image); }, {"a.png", "R, G, B", "depth"});
    expect_error([&] { write_image(folder / "none/a.exr", image); }, {"none/a.exr", "No such file"});
    expect_error([&] { write_image(folder / "a.png", Image(), {}); }, {"no pixels"});
    Image rgb = make_picture(4, 4, {"R", "G", "B"});
    expect_error([&] { write_image(folder / "a.png", rgb, {.png_bits = 12}); }, {"8 or 16"});
    expect_error([&] { write_image(folder / "a.jpg", rgb, {.jpeg_quality = 0}); }, {"1 to 100, not 0"});
    expect_error([&] { write_image(folder / "a.jpg", Image(65530, 1, {"Y"}, PixelFormat::u8)); },
                 {"a.jpg", "65500"});
    image.attributes()["compression"] = std::string("wrong type for this name");
    expect_error([&] { write_image(folder / "a.exr", image); }, {"a.exr"});
    EXPECT_EQ(folder.file_count(), 0);
}

} // namespace
} // namespace montelux
