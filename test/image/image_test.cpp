#include "test/image/image_testing.h"

#include "montelux/image/image.h"

namespace montelux {
namespace {

TEST(Image, KnowsItsChannelsAndSamples) {
    Image image = make_picture(3, 2, {"R", "G", "B", "A", "stderr.Y"});
    EXPECT_EQ(image.sample_count(), 30u);
    EXPECT_EQ(image.byte_count(), 120u);
    EXPECT_EQ(image.index(2, 1, 3), 28u);
    EXPECT_EQ(image.value(2, 1, 3), image.f32()[28]);
    EXPECT_EQ(image.find_channel("stderr.Y"), 4);
    EXPECT_FALSE(image.find_channel("r"));
    EXPECT_EQ(image.color_channels(), (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(image.color_channels("stderr."), (std::vector<int>{4}));
    EXPECT_TRUE(image.color_channels("albedo.").empty());
}

// Y is the luminance of a colour there, and no grey picture.
TEST(Image, XyzIsNotGrey) {
    Image image = make_picture(3, 2, {"X", "Y", "Z", "stderr.X", "stderr.Y", "stderr.Z", "N.X", "N.Y"});
    EXPECT_TRUE(image.color_channels().empty());
    EXPECT_TRUE(image.color_channels("stderr.").empty());
    EXPECT_EQ(make_picture(3, 2, {"Y", "A", "Z"}).color_channels(), (std::vector<int>{0})); // Z is a depth
    EXPECT_EQ(make_picture(3, 2, {"R", "G", "B", "X", "Y", "Z"}).color_channels(),
              (std::vector<int>{0, 1, 2}));
}

TEST(Image, RefusesImpossibleShapes) {
    expect_error([] { Image(0, 3, {"Y"}); }, {"0 x 3"});
    expect_error([] { Image(3, -1, {"Y"}); }, {"3 x -1"});
    expect_error([] { Image(1 << 17, 1, {"Y"}); }, {"65536"});
    expect_error([] { Image(1, 1, {}); }, {"channels"});
    expect_error([] { Image(1, 1, {"Y", "Y"}); }, {"'Y'", "twice"});
    expect_error([] { Image(1, 1, {"Y", ""}); }, {"no name"});
}

TEST(Image, LinearUndoesTheEncodingButNotOfAlpha) {
    Image image(1, 1, {"R", "G", "B", "A"}, PixelFormat::u8, ColorEncoding::srgb());
    for (auto& v : image.u8()) v = 128;
    EXPECT_EQ(image.value(0, 0, 0), 128 / 255.0f);
    EXPECT_EQ(image.linear(0, 0, 0), srgb_to_linear(128 / 255.0f));
    EXPECT_EQ(image.linear(0, 0, 3), 128 / 255.0f);
    Image f = image.to_linear_f32();
    for (int c = 0; c < 4; ++c) EXPECT_EQ(f.value(0, 0, c), image.linear(0, 0, c));
    EXPECT_EQ(f.encoding(), ColorEncoding::linear());
    image.set_encoding(ColorEncoding::linear());
    EXPECT_EQ(image.linear(0, 0, 0), 128 / 255.0f);
    Image wide(1, 1, {"Y"}, PixelFormat::u16, ColorEncoding::gamma(2));
    wide.u16()[0] = 65535 / 5;
    EXPECT_FLOAT_EQ(wide.linear(0, 0, 0), 0.04f);
    EXPECT_FLOAT_EQ(wide.to_linear_f32().value(0, 0, 0), 0.04f);
}

TEST(Image, LayersCanBeAddedAndTakenOut) {
    Image image = make_picture(4, 3, {"R", "G", "B"}), error = make_picture(4, 3, {"R", "G", "B"});
    image.attributes()["spp"] = 16;
    error.f32()[5] = 77;
    Image both = image;
    both.append(error, "stderr.");
    EXPECT_EQ(both.channel_names()[4], "stderr.G");
    EXPECT_EQ(std::get<int>(both.attributes().at("spp")), 16);
    EXPECT_TRUE(same_bits(both.select(image.channel_names()).f32(), image.f32()));
    std::vector<std::string> layer{"stderr.R", "stderr.G", "stderr.B"};
    EXPECT_TRUE(same_bits(both.select(layer).f32(), error.f32()));
    expect_error([&] { image.append(error); }, {"twice"});
    expect_error([&] { image.append(make_picture(3, 4, {"Y"})); }, {"same size"});
    std::vector<std::string> unknown{"Q"};
    expect_error([&] { image.select(unknown); }, {"'Q'", "R, G, B"});
}

} // namespace
} // namespace montelux
