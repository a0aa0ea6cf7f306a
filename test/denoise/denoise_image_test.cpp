// Layers in, layers out.
#include "test/denoise/denoise_testing.h"

#include "montelux/denoise/denoise_image.h"

namespace montelux::denoise_testing {

namespace {

Image picture(const std::vector<std::string>& channels, PixelFormat format = PixelFormat::f32) {
    Image image(5, 4, channels, format);
    for (std::size_t i = 0; i < image.f32().size(); ++i) image.f32()[i] = static_cast<float>(uniform(i));
    image.attributes()["scene"] = std::string("a.pbrt");
    return image;
}

const std::vector<std::string> all{"R",        "G",        "B",   "stderr.R", "albedo.R",
                                   "albedo.G", "albedo.B", "N.X", "N.Y",      "N.Z"};

std::string text(const Image& image, const char* name) {
    auto found = image.attributes().find(name);
    return found == image.attributes().end() ? "" : std::get<std::string>(found->second);
}

TEST(DenoiseImage, AddsLayersAndKeepsTheOthers) {
    StandIn stand_in;
    const Denoiser denoiser(api_of(stand_in));
    const Image before = picture(all);
    Image image = before;
    EXPECT_EQ(denoise_image(denoiser, image).guides, "albedo and normal");
    auto names = all;
    for (const char* name : {"denoised.R", "denoised.G", "denoised.B"}) names.push_back(name);
    EXPECT_EQ(image.channel_names(), names);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 5; ++x) {
            for (int c = 0; c < before.channels(); ++c)
                EXPECT_EQ(image.value(x, y, c), before.value(x, y, c));
            for (int c = 0; c < 3; ++c) EXPECT_EQ(image.value(x, y, before.channels() + c), 0.25f);
        }
    EXPECT_EQ(text(image, "denoiser"), "Open Image Denoise 2.5.1");
    EXPECT_EQ(text(image, "denoiserGuides"), "albedo and normal");
    EXPECT_EQ(text(image, "scene"), "a.pbrt");

    const Image shown = denoised_picture(image);
    EXPECT_EQ(shown.channel_names(), (std::vector<std::string>{"R", "G", "B"}));
    for (float v : shown.f32()) EXPECT_EQ(v, 0.25f);
    EXPECT_EQ(text(shown, "denoiser"), "Open Image Denoise 2.5.1");

    stand_in.output = 0.75f; // a second time: the layers are written over, not doubled
    denoise_image(denoiser, image);
    EXPECT_EQ(image.channel_names(), names);
    EXPECT_EQ(image.value(2, 2, *image.find_channel("denoised.G")), 0.75f);
    EXPECT_EQ(image.value(2, 2, 0), before.value(2, 2, 0));
}

TEST(DenoiseImage, MissingGuidesAreReported) {
    StandIn stand_in;
    const Denoiser denoiser(api_of(stand_in));
    Image bare = picture({"R", "G", "B"}), half = picture({"R", "G", "B"}, PixelFormat::f16),
          no_normal = picture({"R", "G", "B", "albedo.R", "albedo.G", "albedo.B", "N.X"}),
          no_albedo = picture({"R", "G", "B", "N.X", "N.Y", "N.Z"});
    EXPECT_EQ(denoise_image(denoiser, bare).guides, "");
    EXPECT_EQ(text(bare, "denoiserGuides"), "none");
    EXPECT_EQ(denoise_image(denoiser, half).guides, "");
    EXPECT_EQ(half.format(), PixelFormat::f32);
    EXPECT_EQ(denoise_image(denoiser, no_normal).guides, "albedo");
    EXPECT_EQ(denoise_image(denoiser, no_albedo).guides, "");
}

TEST(DenoiseImage, FailuresLeaveTheImageAsItWas) {
    StandIn stand_in;
    stand_in.fail_at = "execute_filter";
    const Denoiser denoiser(api_of(stand_in));
    Image image = picture(all);
    EXPECT_NE(error_of([&] { denoise_image(denoiser, image); }), "");
    EXPECT_EQ(image.channel_names(), all);
    Image grey = picture({"Y", "N.X"});
    EXPECT_EQ(error_of([&] { denoise_image(denoiser, grey); }),
              "denoise: denoising needs the channels R, G and B, but there are Y, N.X");
    EXPECT_NE(error_of([&] { denoised_picture(image); }).find("denoised.R"), std::string::npos);
}

} // namespace

} // namespace montelux::denoise_testing
