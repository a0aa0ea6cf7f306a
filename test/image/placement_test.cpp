// Where images lie in larger ones, and that EXR files keep it.
#include "test/temporary_folder.h"
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <gtest/gtest.h>

#include "montelux/image/image_read.h"
#include "montelux/image/image_write.h"
#include "montelux/image/placement.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// Each sample has a value of its own.
Image numbered(int width, int height, PixelFormat format = PixelFormat::f32) {
    Image image(width, height, {"R", "stderr.R"}, format);
    for (std::size_t i = 0; i < image.sample_count(); ++i)
        if (format == PixelFormat::f32)
            image.f32()[i] = static_cast<float>(i);
        else if (format == PixelFormat::u8)
            image.u8()[i] = static_cast<std::uint8_t>(i);
        else
            image.u16()[i] = static_cast<std::uint16_t>(i);
    return image;
}

TEST(Placement, AnImageIsItsOwnDisplay) {
    const Image image = numbered(5, 3);
    EXPECT_EQ(placement_of(image).data, (PixelWindow{0, 0, 5, 3}));
    EXPECT_EQ(placement_of(image).display, (PixelWindow{0, 0, 5, 3}));
    Image whole = image;
    set_placement(whole, 0, 0, {0, 0, 5, 3});
    EXPECT_TRUE(whole.attributes().empty());
}

TEST(Placement, ExrFilesHaveBothWindows) {
    const TemporaryFolder folder;
    for (const PixelWindow& display : {PixelWindow{0, 0, 64, 48}, {-2, 3, 7, 90}, {20, 30, 25, 33}}) {
        Image image = numbered(5, 3);
        set_placement(image, 20, 30, display);
        write_image(folder / "crop.exr", image);
        const Imf::InputFile file((folder / "crop.exr").c_str());
        const Imath::Box2i& data = file.header().dataWindow();
        EXPECT_EQ(data, Imath::Box2i({20, 30}, {24, 32}));
        const Imath::Box2i& whole = file.header().displayWindow();
        EXPECT_EQ(whole, Imath::Box2i({display.x0, display.y0}, {display.x1 - 1, display.y1 - 1}));
        const Image back = read_image(folder / "crop.exr");
        EXPECT_EQ(placement_of(back).data, (PixelWindow{20, 30, 25, 33}));
        EXPECT_EQ(placement_of(back).display, display);
        EXPECT_TRUE(std::ranges::equal(back.f32(), image.f32()));
        EXPECT_EQ(placement_of(back.select(std::vector<std::string>{"R"})).display, display);
    }
}

TEST(Placement, CutsOutWhatLiesInAWindow) {
    for (const PixelFormat format : {PixelFormat::u8, PixelFormat::u16, PixelFormat::f16, PixelFormat::f32}) {
        Image image = numbered(9, 7, format);
        set_placement(image, 10, 20, {0, 0, 64, 48});
        const Image part = cut_out(image, {12, 21, 15, 25});
        EXPECT_EQ(placement_of(part).data, (PixelWindow{12, 21, 15, 25}));
        EXPECT_EQ(placement_of(part).display, (PixelWindow{0, 0, 64, 48}));
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 3; ++x)
                for (int c = 0; c < 2; ++c) EXPECT_EQ(part.value(x, y, c), image.value(x + 2, y + 1, c));
        EXPECT_THROW(cut_out(image, {9, 21, 15, 25}), Error);
        EXPECT_THROW(cut_out(image, {12, 21, 12, 25}), Error);
        EXPECT_THROW(cut_out(image, {12, 21, 15, 28}), Error);
    }
}

TEST(Placement, FindsCommonPixels) {
    const Image whole = numbered(64, 48);
    Image corner = numbered(32, 24), middle = numbered(32, 24), other = numbered(32, 24);
    set_placement(corner, 32, 24, {0, 0, 64, 48});
    set_placement(middle, 16, 12, {0, 0, 64, 48});
    set_placement(other, 0, 0, {0, 0, 64, 48});
    EXPECT_EQ(common_pixels("a", corner, "b", whole), (PixelWindow{32, 24, 64, 48}));
    EXPECT_EQ(common_pixels("a", whole, "b", corner), (PixelWindow{32, 24, 64, 48}));
    EXPECT_EQ(common_pixels("a", corner, "b", middle), (PixelWindow{32, 24, 48, 36}));
    EXPECT_EQ(common_pixels("a", whole, "b", whole), std::nullopt);
    EXPECT_EQ(common_pixels("a", corner, "b", corner), std::nullopt);
    EXPECT_EQ(common_pixels("a", corner, "b", numbered(32, 24)), std::nullopt); // without a place
    try {
        common_pixels("a.exr", corner, "b.exr", other);
        FAIL() << "nothing in common";
    } catch (const Error& e) {
        EXPECT_STREQ(e.what(),
                     "a.exr: it holds columns 32 to 63, rows 24 to 47, and b.exr columns 0 to 31, rows 0 "
                     "to 23: they have no pixel in common");
    }
}

} // namespace
} // namespace montelux
