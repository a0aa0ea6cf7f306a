// Small files of every kind, written byte by byte, with pixels that are known.
#include "test/image/image_testing.h"
#include "test/image/sample_files.h"
#include <cstdio>
#include <jpeglib.h>

#include "montelux/image/image_read.h"
#include "montelux/image/image_write.h"

namespace montelux {
namespace {

Image read(const std::string& bytes, const std::string& name = "picture") {
    return read_image({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, name);
}

template <std::size_t N>
std::string raw(const char (&text)[N]) {
    return {text, N - 1};
}

std::vector<int> codes(const Image& image) { return {image.u8().begin(), image.u8().end()}; }

TEST(PnmFile, AllSixKinds) {
    EXPECT_EQ(codes(read("P1\n# a comment\n3 2\n1 0 1\n0#x\n10")),
              (std::vector<int>{0, 255, 0, 255, 0, 255}));
    EXPECT_EQ(codes(read("P2 2 1 255 0 200")), (std::vector<int>{0, 200}));
    EXPECT_EQ(codes(read("P3 1 1 15 0 5 15")), (std::vector<int>{0, 85, 255}));
    EXPECT_EQ(codes(read(raw("P4 9 2\n\x80\x80\x00\x00"))),
              (std::vector<int>{0, 255, 255, 255, 255, 255, 255, 255, 0, 255, 255, 255, 255, 255, 255, 255,
                                255, 255}));
    EXPECT_EQ(codes(read(raw("P5\n2 1\n255\n\x01\xfe"))), (std::vector<int>{1, 254}));
    Image wide = read(raw("P6\n1 1\n65535\n\x01\x02\xff\xff\x00\x00"));
    ASSERT_EQ(wide.format(), PixelFormat::u16);
    EXPECT_EQ(wide.u16()[0], 0x102);
    EXPECT_EQ(wide.u16()[1], 0xffff);
    EXPECT_EQ(wide.channel_names()[0], "R");
}

TEST(PnmFile, DamageIsAnError) {
    expect_error([] { read("P5\n2 2\n255\nabc"); }, {"3 bytes of pixels instead of 4"});
    expect_error([] { read("P2 1 1 9 10"); }, {"sample 10"});
    expect_error([] { read("P2 1 1 9 x"); }, {"'x'"});
    expect_error([] { read("P5 1 1 70000 x"); }, {"70000"});
    expect_error([] { read("P5 60000 60000 255 x"); }, {"60000 x 60000", "MiB"});
    expect_error([] { read("P5 99999999999 1 255 x"); }, {"width"});
    expect_error([] { read("P5 0 1 255 x"); }, {"no pixels"});
}

std::string tga_header(int type, int width, int height, int bits, int descriptor) {
    std::string h(18, '\0');
    h[2] = static_cast<char>(type);
    h[12] = static_cast<char>(width);
    h[14] = static_cast<char>(height);
    h[16] = static_cast<char>(bits);
    h[17] = static_cast<char>(descriptor);
    return h;
}

TEST(TgaFile, PlainRunsAndBothDirections) {
    // Bottom-up, blue first.
    Image plain = read(tga_header(2, 1, 2, 24, 0) + "\x01\x02\x03\x04\x05\x06", "a.tga");
    EXPECT_EQ(codes(plain), (std::vector<int>{6, 5, 4, 3, 2, 1}));
    EXPECT_EQ(plain.encoding(), ColorEncoding::srgb());
    Image top_down = read(tga_header(2, 1, 2, 24, 0x20) + "\x01\x02\x03\x04\x05\x06", "a.TGA");
    EXPECT_EQ(codes(top_down), (std::vector<int>{3, 2, 1, 6, 5, 4}));
    Image alpha = read(tga_header(2, 1, 1, 32, 0x28) + "\x01\x02\x03\x04", "a.tga");
    EXPECT_EQ(codes(alpha), (std::vector<int>{3, 2, 1, 4}));
    EXPECT_EQ(alpha.channel_names()[3], "A");
    Image runs = read(tga_header(11, 3, 1, 8, 0x20) + "\x81\x07\x01\x09", "a.tga");
    EXPECT_EQ(codes(runs), (std::vector<int>{7, 7, 9}));
    Image grey = read(tga_header(3, 2, 1, 8, 0x20) + "\x07\x08", "a.tga");
    EXPECT_EQ(codes(grey), (std::vector<int>{7, 8}));
}

TEST(TgaFile, TruncationIsAnError) {
    expect_error([] { read(tga_header(2, 9, 9, 24, 0) + std::string(200, 'x'), "a.tga"); },
                 {"ends too early"});
    expect_error([] { read(tga_header(10, 9, 9, 24, 0) + "\x81\x07", "a.tga"); }, {"ends too early"});
    expect_error([] { read(tga_header(2, 1, 1, 24, 0).substr(0, 12), "a.tga"); }, {"a.tga"});
}

TEST(BmpFile, IsRead) {
    std::string bmp = raw("BM\x3e\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\x01\0\0\0\x02\0\0\0\x01\0\x18\0"
                          "\0\0\0\0\x08\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x01\x02\x03\0\x04\x05\x06\0");
    EXPECT_EQ(codes(read(bmp)), (std::vector<int>{6, 5, 4, 3, 2, 1}));
    expect_error([&] { read(bmp.substr(0, 56)); }, {"ends too early"});
}

TEST(HdrFile, OldAndNewCodingAndOddHeaders) {
    std::string head =
        "#?RGBE\n# a remark\nGAMMA=1\nPRIMARIES=0 0 0 0 0 0 0 0\nEXPOSURE=2\nFormat=32-bit_rle_rgbe\n\n";
    // A pixel (128, 64, 32) * 2^-7, repeated twice; then black.
    Image old = read(head + "-Y 1 +X 4\n" + raw("\x80\x40\x20\x81\x01\x01\x01\x02\0\0\0\0"));
    EXPECT_EQ(old.value(0, 0, 0), 1);
    EXPECT_EQ(old.value(2, 0, 1), 0.5f);
    EXPECT_EQ(old.value(2, 0, 2), 0.25f);
    EXPECT_EQ(old.value(3, 0, 0), 0);
    EXPECT_EQ(std::get<std::string>(old.attributes().at("hdr.EXPOSURE")), "2");
    // 8 pixels in four component runs; green counts up.
    Image runs = read(head + "-Y 1 +X 8\n" +
                      raw("\x02\x02\x00\x08\x88\x80\x08\x01\x02\x03\x04\x05\x06\x07\x08\x88\x20\x88\x88"));
    EXPECT_EQ(runs.value(7, 0, 0), 128);
    EXPECT_EQ(runs.value(6, 0, 1), 7);
    EXPECT_EQ(runs.value(0, 0, 2), 32);
    // 300 = 1 + 43 + 1 * 256 equal pixels: two counts, the second with the weight 256.
    Image many = read(head + "-Y 1 +X 300\n" + raw("\x80\x40\x20\x81\x01\x01\x01\x2b\x01\x01\x01\x01"));
    EXPECT_EQ(many.value(299, 0, 0), 1);
    // Repetition counts start anew at each pixel: 3, 257 and 2.
    Image several = read(head + "-Y 1 +X 262\n" +
                         raw("\x80\x40\x20\x81\x01\x01\x01\x02\x80\x40\x20\x82\x01\x01\x01\x00"
                             "\x01\x01\x01\x01\x80\x40\x20\x81\x01\x01\x01\x01"));
    for (int x = 0; x < 262; ++x) ASSERT_EQ(several.value(x, 0, 0), x < 3 || x >= 260 ? 1 : 2) << x;
}

// CIE XYZ, whose white (1, 1, 1) becomes that of sRGB.
TEST(HdrFile, XyzBecomesLinearSrgb) {
    const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 3\n";
    // (1, 1, 1); (1, 0.5, 0.25); (0.25, 0.5, 1).
    const Image image = read(head + raw("\x80\x80\x80\x81\x80\x40\x20\x81\x20\x40\x80\x81"));
    EXPECT_EQ(image.channel_names(), (std::vector<std::string>{"R", "G", "B"}));
    // By Bradford's method from the white (1/3, 1/3) to (0.3127, 0.3290), then by the primaries of BT.709.
    const float expected[] = {1,          1,           1,          2.1933773f, -0.0077020f,
                              0.2440550f, -0.5267614f, 0.7687628f, 1.0595855f};
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(image.f32()[i], expected[i], 1e-5f) << i;
}

TEST(HdrFile, OrientationsAreTurnedUpright) {
    // Four pixels with exponents that make red 1, 2, 4, 8.
    std::string pixels = raw("\x80\0\0\x81\x80\0\0\x82\x80\0\0\x83\x80\0\0\x84");
    auto red = [&](const char* resolution) {
        Image i = read("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + std::string(resolution) + "\n" + pixels);
        return std::vector<float>{i.value(0, 0, 0), i.value(1, 0, 0), i.value(0, 1, 0), i.value(1, 1, 0)};
    };
    EXPECT_EQ(red("-Y 2 +X 2"), (std::vector<float>{1, 2, 4, 8}));
    EXPECT_EQ(red("+Y 2 +X 2"), (std::vector<float>{4, 8, 1, 2}));
    EXPECT_EQ(red("-Y 2 -X 2"), (std::vector<float>{2, 1, 8, 4}));
    EXPECT_EQ(red("+X 2 -Y 2"), (std::vector<float>{1, 4, 2, 8}));
    EXPECT_EQ(red("-X 2 +Y 2"), (std::vector<float>{8, 4 / 2.0f, 4, 1}));
}

TEST(HdrFile, DamageIsAnError) {
    std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    expect_error([&] { read(head + "-Y 1 +X 4\n" + raw("\x80\x40\x20\x81")); }, {"ends too early"});
    expect_error([&] { read(head + "-Y 1 +X 2\n" + raw("\x80\x40\x20\x81\x01\x01\x01\x02")); },
                 {"run is longer"});
    expect_error([&] { read(head + "-Y 1 +X 2\n" + raw("\x01\x01\x01\x02")); }, {"begins with a repetition"});
    expect_error([&] { read(head + "-Y x +X 2\n"); }, {"resolution", "-Y x +X 2"});
    expect_error([&] { read("#?RADIANCE\nFORMAT=8-bit\n\n-Y 1 +X 1\n1234"); }, {"8-bit"});
    expect_error([&] { read("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n"); }, {"no end"});
    expect_error([&] { read(head + "-Y 60000 +X 60000\n"); }, {"MiB", "limit"});
    expect_error([&] { read(head + "-Y 5000 +X 5000\n" + std::string(30000, '\x01')); },
                 {"out of proportion"});
}

TEST(JpegFile, GreyColorAndProgressive) {
    for (int components : {1, 3})
        for (bool progressive : {false, true}) {
            Image image = read(make_jpeg(32, 24, components, progressive));
            ASSERT_EQ(image.channels(), components);
            EXPECT_EQ(image.encoding(), ColorEncoding::srgb());
            for (int y = 0; y < 24; ++y)
                for (int x = 0; x < 32; ++x)
                    for (int c = 0; c < components; ++c)
                        EXPECT_NEAR(image.u8()[image.index(x, y, c)], x * 3 + y + 40 * c, 6);
        }
}

TEST(JpegFile, DamageIsAnError) {
    std::string jpeg = make_jpeg(200, 100, 3, false);
    expect_error([&] { read(jpeg.substr(0, jpeg.size() / 2)); }, {"JPEG file is damaged", "remature end"});
    expect_error([&] { read(make_jpeg(8, 8, 4, false)); }, {"CMYK"});
    // The height, after the frame header's mark and 3 bytes, says 65500.
    auto frame = jpeg.find("\xff\xc0");
    std::string bomb = jpeg;
    bomb[frame + 5] = bomb[frame + 7] = '\xff';
    expect_error([&] { read(bomb); }, {"MiB"});
}

TEST(PngFile, DamageIsAnError) {
    TemporaryFolder folder;
    Image image(40, 30, {"R", "G", "B"}, PixelFormat::u8, ColorEncoding::srgb());
    for (std::size_t i = 0; i < image.sample_count(); ++i)
        image.u8()[i] = static_cast<std::uint8_t>(256 * noise(i));
    write_image(folder / "a.png", image);
    std::string png = read_bytes(folder / "a.png");
    expect_error([&] { read(png.substr(0, png.size() / 2)); }, {"PNG file is damaged", "too early"});
    std::string flipped = png;
    flipped[png.size() / 2] ^= 1;
    expect_error([&] { read(flipped); }, {"PNG file is damaged"});
}

} // namespace
} // namespace montelux
