// The denoiser against the real library where there is one, and its manners against a stand-in everywhere.
#include "test/denoise/denoise_testing.h"
#include <limits>

#include "montelux/denoise/denoiser.h"

namespace montelux::denoise_testing {

namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();

using DenoiserReal = RealDenoiser;

TEST_F(DenoiserReal, NoiseFallsToASixth) {
    const Synthetic s;
    double before = relative_error(s.noisy, s.truth);
    EXPECT_NEAR(before, 0.5, 0.01);
    EXPECT_LT(relative_error(denoiser_->denoise(s.input()).color, s.truth), before / 6);
}

TEST_F(DenoiserReal, EdgesStay) {
    const Synthetic s;
    const auto out = denoiser_->denoise(s.input()).color;
    // On either side of the square's left rim the picture is nearer to its own side's truth: of a contrast of
    // 7 to 1 at least 90 % are left. Means over the rim's rows.
    double inside = 0, outside = 0, inside_truth = 0, outside_truth = 0;
    for (int y = s.height / 4 + 2; y < 3 * s.height / 4 - 2; ++y) {
        std::size_t at = 3 * (static_cast<std::size_t>(y) * s.width + s.width / 3);
        inside += out[at];
        outside += out[at - 3];
        inside_truth += s.truth[at];
        outside_truth += s.truth[at - 3];
    }
    EXPECT_GT(outside - inside, 0.9 * (outside_truth - inside_truth));
    EXPECT_LT(outside - inside, 1.1 * (outside_truth - inside_truth));
}

TEST_F(DenoiserReal, SameBitsTwiceAndForAnyNumberOfThreads) {
    const Synthetic s(201, 143);
    const auto once = denoiser_->denoise(s.input()).color;
    EXPECT_EQ(once, denoiser_->denoise(s.input()).color);
    for (int threads : {0, 1, 3})
        EXPECT_EQ(once, Denoiser::load(threads).denoise(s.input()).color) << threads;
}

TEST_F(DenoiserReal, ScaleOfTheLightChangesNothingElse) {
    Synthetic s;
    const auto once = denoiser_->denoise(s.input()).color;
    for (float& v : s.noisy) v *= 1024;
    auto scaled = denoiser_->denoise(s.input()).color;
    for (float& v : scaled) v /= 1024;
    EXPECT_LT(relative_error(scaled, once), 0.01);
}

TEST_F(DenoiserReal, PixelsThatAreNotFiniteAreFilledFromTheirNeighbours) {
    Synthetic s;
    const auto clean = denoiser_->denoise(s.input()).color;
    std::size_t at = 3 * (static_cast<std::size_t>(10) * s.width + 80);
    s.noisy[at] = nan;
    s.noisy[at + 300 * 3] = inf;
    s.noisy[0] = -inf;
    const auto out = denoiser_->denoise(s.input());
    EXPECT_EQ(out.not_finite, 3u);
    EXPECT_LT(relative_error(out.color, s.truth), 1.1 * relative_error(clean, s.truth));
}

TEST_F(DenoiserReal, EveryNumberOfGuidesAndSmallAndBlackPicturesWork) {
    const Synthetic s;
    double before = relative_error(s.noisy, s.truth);
    auto input = s.input();
    input.normal = {};
    EXPECT_LT(relative_error(denoiser_->denoise(input).color, s.truth), before / 3);
    input.albedo = {};
    EXPECT_LT(relative_error(denoiser_->denoise(input).color, s.truth), before / 3);

    const std::vector<float> grey(3, 0.5f), black(3 * 17 * 5, 0.0f), huge(3 * 9, 3e38f);
    EXPECT_EQ(denoiser_->denoise({1, 1, grey, grey, grey}).color.size(), 3u);
    for (float v : denoiser_->denoise({17, 5, black, black, black}).color) EXPECT_NEAR(v, 0, 1e-3);
    // The filter may refuse such light, with a sentence; it may not give infinities.
    try {
        for (float v : denoiser_->denoise({3, 3, huge, {}, {}}).color) EXPECT_TRUE(std::isfinite(v));
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("not finite"), std::string::npos) << e.what();
    }
}

TEST(Denoiser, AsksTheLibraryForWhatItNeeds) {
    StandIn stand_in;
    const Synthetic s(5, 4);
    {
        const Denoiser denoiser(api_of(stand_in), 3);
        EXPECT_EQ(denoiser.name(), "Open Image Denoise 2.5.1");
        EXPECT_EQ(stand_in.threads, 3);
        EXPECT_FALSE(stand_in.affinity);
        EXPECT_EQ(denoiser.denoise(s.input()).color, std::vector<float>(60, 0.25f));
        EXPECT_EQ(stand_in.runs,
                  (std::vector<std::string>{"RT albedo output", "RT normal output",
                                            "RT color albedo normal output hdr=1 cleanAux=1"}));
        stand_in.runs.clear();
        denoiser.denoise({s.width, s.height, s.noisy, {}, {}});
        EXPECT_EQ(stand_in.runs, std::vector<std::string>{"RT color output hdr=1"});
    }
    EXPECT_EQ(stand_in.devices, 0);
    EXPECT_EQ(stand_in.filters, 0);
}

TEST(Denoiser, NothingBadReachesTheFilter) {
    StandIn stand_in;
    const Denoiser denoiser(api_of(stand_in));
    Synthetic s(5, 4);
    s.noisy[0] = nan;
    s.noisy[16] = inf;
    s.noisy[17] = -1; // the same pixel: counted once, as not finite
    s.noisy[30] = -0.5f;
    s.albedo[0] = nan; // the first pixel again
    s.albedo[21] = nan;
    s.normal[44] = -inf;
    const auto out = denoiser.denoise(s.input());
    EXPECT_FALSE(stand_in.bad_input);
    EXPECT_EQ(out.not_finite, 4u);
    EXPECT_EQ(out.negative, 1u);
    const std::vector<float> all_bad(60, nan);
    EXPECT_EQ(denoiser.denoise({5, 4, all_bad, all_bad, all_bad}).not_finite, 20u);
    EXPECT_FALSE(stand_in.bad_input);
}

TEST(Denoiser, HolesAreTheMeanOfAllEightNeighbours) {
    StandIn stand_in;
    const Denoiser denoiser(api_of(stand_in));
    std::vector<float> color(27);
    for (std::size_t i = 0; i < color.size(); ++i) color[i] = static_cast<float>(1u << (i / 3));
    color[13] = nan;
    denoiser.denoise({3, 3, color, {}, {}});
    const std::vector<float>& filtered = stand_in.inputs.at("color");
    for (std::size_t i = 0; i < color.size(); ++i)
        EXPECT_EQ(filtered[i], i / 3 == 4 ? (511.0f - 16) / 8 : color[i]) << i;
}

TEST(Denoiser, GuidesKeepTheirRange) {
    StandIn stand_in;
    const Denoiser denoiser(api_of(stand_in));
    const std::vector<float> color(3, 0.5f), albedo{-0.5f, 0.25f, 1.5f}, normal{-0.75f, 0.25f, -1.5f};
    denoiser.denoise({1, 1, color, albedo, normal});
    EXPECT_EQ(stand_in.inputs.at("albedo"), (std::vector<float>{0, 0.25f, 1}));
    EXPECT_EQ(stand_in.inputs.at("normal"), (std::vector<float>{-0.75f, 0.25f, -1}));
}

TEST(Denoiser, FailuresOfTheLibraryAreErrorsAndNothingLeaks) {
    const Synthetic s(5, 4);
    struct Case {
        const char *call, *text;
    };
    for (auto [call, text] : {Case{"new_device", "no device could be made"},
                              Case{"commit_device", "the device could not be started"},
                              Case{"new_filter", "no filter could be made"},
                              Case{"commit_filter", "the filter could not be prepared"},
                              Case{"execute_filter", "the picture could not be filtered"}}) {
        StandIn stand_in;
        stand_in.fail_at = call;
        std::string message = error_of([&] { Denoiser(api_of(stand_in)).denoise(s.input()); });
        EXPECT_EQ(message, "stand-in: Open Image Denoise failed, " + std::string(text) + ": " + call +
                               " went wrong (error 2)");
        EXPECT_EQ(stand_in.devices, 0) << call;
        EXPECT_EQ(stand_in.filters, 0) << call;
    }
    StandIn mute;
    mute.no_device = true;
    EXPECT_NE(error_of([&] { Denoiser(api_of(mute)); }).find("no device could be made"), std::string::npos);
    StandIn filterless;
    filterless.no_filter = true;
    EXPECT_NE(error_of([&] { Denoiser(api_of(filterless)).denoise(s.input()); }).find("no filter"),
              std::string::npos);
    StandIn old;
    old.version = 10399;
    EXPECT_NE(error_of([&] { Denoiser(api_of(old)); }).find("1.3.99; 1.4 or newer is expected"),
              std::string::npos);
    StandIn wild;
    wild.output = nan;
    EXPECT_NE(error_of([&] { Denoiser(api_of(wild)).denoise(s.input()); }).find("not finite at pixel 0,0"),
              std::string::npos);
}

TEST(Denoiser, InputsThatDoNotFitAreRefused) {
    StandIn stand_in;
    const Denoiser denoiser(api_of(stand_in));
    const Synthetic s(5, 4);
    auto refused = [&](const DenoiserInput& input, const char* text) {
        std::string message = error_of([&] { denoiser.denoise(input); });
        EXPECT_NE(message.find(text), std::string::npos) << message;
    };
    refused({0, 4, {}, {}, {}}, "no pixels");
    refused({4, 4, s.noisy, s.albedo, s.normal}, "the colour has 60 numbers");
    refused({5, 4, s.noisy, std::span(s.albedo).first(57), s.normal}, "the albedo has 57 numbers");
    refused({5, 4, s.noisy, s.albedo, std::span(s.normal).first(3)}, "the normal has 3 numbers");
    refused({5, 4, s.noisy, {}, s.normal}, "without an albedo");
    EXPECT_NE(error_of([&] { Denoiser(api_of(stand_in), -1); }).find("must not be negative"),
              std::string::npos);
    EXPECT_TRUE(stand_in.runs.empty());
}

} // namespace

} // namespace montelux::denoise_testing
