#include "test/image/image_testing.h"
#include <algorithm>
#include <limits>
#include <utility>

#include "montelux/image/difference_picture.h"
#include "montelux/image/metrics.h"
#include "montelux/mc/math/constants.h"

namespace montelux {
namespace {

constexpr float nan_f = std::numeric_limits<float>::quiet_NaN();

Image grey(std::vector<float> values) {
    Image image(static_cast<int>(values.size()), 1, {"Y"});
    std::copy(values.begin(), values.end(), image.f32().begin());
    return image;
}

// Box and Muller 1958, "A Note on the Generation of Random Normal Deviates".
double gaussian(std::uint64_t i) {
    double radius = std::sqrt(-2 * std::log(1 - noise(2 * i))), angle = 2 * pi * noise(2 * i + 1);
    return radius * std::cos(angle);
}

TEST(Metrics, EqualHandComputedValues) {
    Image a = grey({1, 2, 3, 4}), b = grey({1, 1, 5, 4});
    Comparison r = compare_pictures(measured_picture("a", a), measured_picture("b", b));
    EXPECT_EQ(r.pixels, 4u);
    EXPECT_DOUBLE_EQ(r.rmse, std::sqrt(5.0 / 4));
    EXPECT_DOUBLE_EQ(r.rel_mse, (1 / 1.01 + 4 / 25.01) / 4);
    EXPECT_DOUBLE_EQ(r.channels[0].mean_a, 2.5);
    EXPECT_DOUBLE_EQ(r.channels[0].mean_b, 2.75);
    EXPECT_DOUBLE_EQ(r.channels[0].relative_mean_difference, 2.5 / 2.75 - 1);
    EXPECT_FALSE(r.a_has_error || r.b_has_error);
    EXPECT_EQ(r.z.count, 0u);
    EXPECT_TRUE(std::isnan(r.channels[0].mean_difference_error));
}

TEST(Metrics, ZScoresUseBothErrors) {
    Image a = grey({1, 2, 3, 4, 9, 5}), b = grey({1, 1, 5, 4, 8, 7});
    Image sa = grey({3, 0.6f, 0, 0, 0, nan_f}), sb = grey({4, 0.8f, 2, 0, 0, 1});
    Comparison r = compare_pictures(measured_picture("a", a, "sa", sa), measured_picture("b", b, "sb", sb));
    // z: 0 / 5, 1 / 1, -2 / 2; then equal without error, unexplained, invalid.
    EXPECT_EQ(r.z.count, 3u);
    EXPECT_NEAR(r.z.mean, 0, 1e-7);
    EXPECT_NEAR(r.z.standard_deviation, 1, 1e-7);
    EXPECT_NEAR(r.z.largest, 1, 1e-7);
    EXPECT_EQ(r.z.equal_without_error, 1u);
    EXPECT_EQ(r.z.unexplained, 1u);
    EXPECT_EQ(r.z.invalid_errors, 1u);
    EXPECT_DOUBLE_EQ(r.z.within[2], 1);
    EXPECT_NEAR(r.channels[0].mean_difference_error, std::sqrt(25.0 + 1 + 4) / 6, 1e-7);
    // One side alone.
    Comparison one = compare_pictures(measured_picture("a", a), measured_picture("b", b, "sb", sb));
    EXPECT_FALSE(one.a_has_error);
    EXPECT_TRUE(one.b_has_error);
    EXPECT_NEAR(one.z.largest, 2, 1e-6); // (5 - 7) / 1
}

TEST(Metrics, FindsTheErrorLayerOfAnImage) {
    Image a = make_picture(4, 4, {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B"});
    EXPECT_TRUE(measured_picture("a", a).has_error());
    EXPECT_EQ(measured_picture("a", a).error_channels, (std::vector<int>{3, 4, 5}));
    Image plain = make_picture(4, 4, {"R", "G", "B"});
    EXPECT_FALSE(measured_picture("a", plain).has_error());
    // As a file of errors: its stderr layer comes before its colours.
    EXPECT_EQ(measured_picture("a", plain, "e", a).error_channels, (std::vector<int>{3, 4, 5}));
    EXPECT_EQ(measured_picture("a", plain, "e", plain).error_channels, (std::vector<int>{0, 1, 2}));
}

// 60000 Gaussian scores of each: the standard deviation of the sample standard deviation is 0.0029, and that
// of the share within 1 is 0.0019. All bounds are 5 of these or more: a false alarm below 3e-6 in all; the
// seed is fixed.
TEST(Metrics, ScoresOfHonestErrorsAreStandardNormal) {
    int width = 200, height = 100;
    std::vector<std::string> names{"R", "G", "B", "stderr.R", "stderr.G", "stderr.B"};
    Image a(width, height, names), b(width, height, names);
    std::uint64_t i = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c, ++i) {
                double truth = 1 + noise(7000000 + i), sa = 0.3 * noise(8000000 + i) + 0.01, sb = 0.05;
                a.set(x, y, c, static_cast<float>(truth + sa * gaussian(i)));
                b.set(x, y, c, static_cast<float>(truth + sb * gaussian(1000000 + i)));
                a.set(x, y, c + 3, static_cast<float>(sa));
                b.set(x, y, c + 3, static_cast<float>(sb));
            }
    Comparison r = compare_pictures(measured_picture("a", a), measured_picture("b", b));
    ASSERT_EQ(r.z.count, 60000u);
    EXPECT_NEAR(r.z.mean, 0, 5 * 0.0041);
    EXPECT_NEAR(r.z.standard_deviation, 1, 5 * 0.0029);
    EXPECT_NEAR(r.z.within[0], ZScores::expected_within[0], 5 * 0.0019);
    EXPECT_NEAR(r.z.within[1], ZScores::expected_within[1], 5 * 0.00085);
    EXPECT_NEAR(r.z.within[2], ZScores::expected_within[2], 6 * 0.00021);
    for (const ChannelComparison& c : r.channels)
        EXPECT_LT(std::abs(c.mean_a - c.mean_b), 5 * c.mean_difference_error);
    // Errors reported at half of their size give scores twice as wide.
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 3; c < 6; ++c) {
                a.set(x, y, c, a.value(x, y, c) / 2);
                b.set(x, y, c, b.value(x, y, c) / 2);
            }
    Comparison half = compare_pictures(measured_picture("a", a), measured_picture("b", b));
    EXPECT_NEAR(half.z.standard_deviation, 2, 10 * 0.0029);
}

TEST(Metrics, SkewnessOfADifferenceIsThatOfBothPictures) {
    const std::vector<std::string> names{"Y", "stderr.Y", "skewness.Y"};
    Image a(1, 1, names), b(1, 1, names);
    const auto fill = [](Image& image, std::vector<float> values) {
        std::copy(values.begin(), values.end(), image.f32().begin());
    };
    const auto scores = [&] { return compare_pictures(measured_picture("a", a), measured_picture("b", b)); };
    // Third cumulants 0.5 * 3^3 and 1 * 4^3, a variance of 3^2 + 4^2, a difference of one standard deviation:
    // by the formula of skew_corrected_z, 1 + g / 6 + g / 3 for the skewness g = (13.5 - 64) / 125.
    fill(a, {7, 3, 0.5f});
    fill(b, {2, 4, 1});
    EXPECT_DOUBLE_EQ(scores().z.mean, 1);
    EXPECT_DOUBLE_EQ(scores().skew_corrected.mean, 1 + (13.5 - 64) / 125 / 2);
    // Swapped pictures change the signs of the difference and its skewness.
    std::swap(a, b);
    EXPECT_DOUBLE_EQ(scores().skew_corrected.mean, -1 - (13.5 - 64) / 125 / 2);
    // Equal skewness cancels.
    fill(a, {7, 3, 2});
    fill(b, {4, 3, 2});
    EXPECT_DOUBLE_EQ(scores().skew_corrected.mean, scores().z.mean);
    // Only one picture has a skewness.
    b = grey({4});
    EXPECT_DOUBLE_EQ(scores().skew_corrected.mean, 1 + 2 / 2.0);
}

TEST(Metrics, SetsTheNoisiestReferencePixelsAside) {
    std::vector<float> va(100, 1), vb(100, 1), error(100, 0.01f);
    vb[17] = 50; // bright and noisy, but less so beside its light than the next
    error[17] = 0.6f;
    vb[40] = 3;
    error[40] = 0.5f;
    Image a = grey(va), b = grey(vb), sb = grey(error);
    auto with = [&](double percent) {
        return compare_pictures(measured_picture("a", a), measured_picture("b", b, "sb", sb),
                                {.set_aside_percent = percent});
    };
    EXPECT_EQ(with(0).pixels, 100u);
    EXPECT_EQ(with(0.99).set_aside, 0u);
    Comparison one = with(1);
    EXPECT_EQ(one.set_aside, 1u);
    EXPECT_EQ(one.pixels, 99u);
    EXPECT_DOUBLE_EQ(one.rmse, std::sqrt(49.0 * 49 / 99)); // only the difference at 17 is left
    EXPECT_DOUBLE_EQ(with(2).rmse, 0);
    expect_error([&] { with(100); }, {"below 100"});
    expect_error(
        [&] {
            compare_pictures(measured_picture("a", a), measured_picture("b", b), {.set_aside_percent = 1});
        },
        {"standard errors"});
}

TEST(Metrics, PixelsThatAreNotFiniteAreLeftOutAndCounted) {
    Image a = grey({1, nan_f, 3}), b = grey({2, 1, std::numeric_limits<float>::infinity()});
    Comparison r = compare_pictures(measured_picture("a", a), measured_picture("b", b));
    EXPECT_EQ(r.not_finite, 2u);
    EXPECT_EQ(r.pixels, 1u);
    EXPECT_DOUBLE_EQ(r.rmse, 1);
    Image none = grey({nan_f, nan_f, nan_f});
    expect_error([&] { compare_pictures(measured_picture("a", none), measured_picture("b", b)); },
                 {"no pixel"});
}

TEST(Metrics, RefusesPicturesThatDoNotMatch) {
    Image a = make_picture(4, 3, {"R", "G", "B"}), b = make_picture(3, 4, {"R", "G", "B"}),
          c = make_picture(4, 3, {"Y"}), d = make_picture(4, 3, {"depth"});
    auto pa = measured_picture("a.exr", a);
    expect_error([&] { compare_pictures(pa, measured_picture("b.exr", b)); },
                 {"a.exr is 4 x 3", "b.exr is 3 x 4"});
    expect_error([&] { compare_pictures(pa, measured_picture("c.exr", c)); }, {"c.exr is grey"});
    expect_error([&] { measured_picture("d.exr", d); }, {"d.exr", "R, G, B"});
    expect_error([&] { measured_picture("a.exr", a, "b.exr", b); }, {"b.exr", "3 x 4"});
    expect_error([&] { measured_picture("a.exr", a, "c.exr", c); }, {"c.exr", "3 colour"});
    expect_error([&] { compare_pictures(pa, pa, {.relative_epsilon = 0}); }, {"epsilon"});
}

TEST(ChannelSummary, CountsWhatIsNotANumber) {
    Image image = grey({1, -2, nan_f, std::numeric_limits<float>::infinity(), 4});
    ChannelSummary s = summarize_channel(image, 0);
    EXPECT_EQ(s.minimum, -2);
    EXPECT_EQ(s.maximum, 4);
    EXPECT_DOUBLE_EQ(s.mean, 1);
    EXPECT_EQ(s.finite, 3u);
    EXPECT_EQ(s.nan, 1u);
    EXPECT_EQ(s.infinite, 1u);
    EXPECT_EQ(s.negative, 1u);
    EXPECT_TRUE(std::isnan(summarize_channel(grey({nan_f}), 0).mean));
}

TEST(DifferencePicture, IsSignedAndScaled) {
    Image a = grey({1, 2, 0.5f, nan_f}), b = grey({1, 1, 1, 1});
    auto d = difference_picture(measured_picture("a", a), measured_picture("b", b),
                                DifferenceMeasure::relative, 1);
    auto at = [&](int x, int c) { return static_cast<int>(d.picture.u8()[d.picture.index(x, 0, c)]); };
    for (int c = 0; c < 3; ++c) EXPECT_EQ(at(0, c), 255);
    EXPECT_GT(at(1, 0), at(1, 2) + 100); // brighter: red
    EXPECT_GT(at(2, 2), at(2, 0) + 50);  // darker: blue
    EXPECT_EQ(at(3, 0), 255);
    EXPECT_EQ(at(3, 1), 0);
    EXPECT_EQ(at(3, 2), 255);
    auto automatic = difference_picture(measured_picture("a", a), measured_picture("b", b));
    EXPECT_NEAR(automatic.full_scale, 0.5, 0.001); // of 0, 0.5, 1 the 99th percentile, rounded down
    Image s = grey({0.5f, 0.5f, 0.5f, 0.5f});
    auto z = difference_picture(measured_picture("a", a), measured_picture("b", b, "s", s),
                                DifferenceMeasure::z_score);
    EXPECT_DOUBLE_EQ(z.full_scale, 1); // 0.5 / 0.5
    expect_error(
        [&] {
            difference_picture(measured_picture("a", a), measured_picture("b", b),
                               DifferenceMeasure::z_score);
        },
        {"standard errors"});
}

TEST(DifferencePicture, PixelsThatAreNotFiniteChangeNoOthers) {
    const Image a = grey({1, 2, 0.5f, 3}), b = grey({1, 1, 1, 4});
    const auto alone = difference_picture(measured_picture("a", a), measured_picture("b", b));
    for (const float bad : {nan_f, std::numeric_limits<float>::infinity()}) {
        const Image more_a = grey({1, 2, 0.5f, 3, 1}), more_b = grey({1, 1, 1, 4, bad});
        const auto both = difference_picture(measured_picture("a", more_a), measured_picture("b", more_b));
        EXPECT_EQ(both.full_scale, alone.full_scale) << bad;
        const auto codes = both.picture.u8();
        EXPECT_TRUE(std::equal(codes.begin(), codes.begin() + 12, alone.picture.u8().begin())) << bad;
        EXPECT_EQ(std::vector<int>(codes.begin() + 12, codes.end()), (std::vector<int>{255, 0, 255})) << bad;
    }
}

} // namespace
} // namespace montelux
