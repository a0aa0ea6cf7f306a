#include "test/image/image_testing.h"

#include "montelux/image/metrics.h"
#include "montelux/image/variance_pool.h"
#include "montelux/mc/stats/moments.h"

namespace montelux {
namespace {

TEST(VariancePool, IsTheMeanOfTheKnownOnesAroundAPixel) {
    // 4 x 3 pixels, one of them not known.
    std::vector<double> v{1, 2, 3, 4, 5, -1, 7, 8, 9, 10, 11, 12};
    std::vector<double> p = pool_variances(v, 4, 3);
    EXPECT_DOUBLE_EQ(p[0], (1 + 2 + 5) / 3.0);
    EXPECT_DOUBLE_EQ(p[2], (2 + 3 + 4 + 7 + 8) / 5.0);
    EXPECT_EQ(p[5], -1);
    EXPECT_DOUBLE_EQ(p[6], (2 + 3 + 4 + 7 + 8 + 10 + 11 + 12) / 8.0);
    EXPECT_DOUBLE_EQ(p[11], (7 + 8 + 11 + 12) / 4.0);
    EXPECT_EQ(pool_variances(std::vector<double>{3}, 1, 1), std::vector<double>{3});
}

constexpr int columns = 250, rows = 200;

// Each pixel is the mean of 16 exponential samples around a truth that varies over the picture, so its own
// skewness is 2 / 4 = 0.5; `bias` is added to it in units of its true error.
Image skewed_picture(std::uint64_t seed, double bias = 0) {
    constexpr int samples = 16;
    Image image(columns, rows, {"Y", "stderr.Y"});
    std::uint64_t draw = seed * 1000000000;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            double truth = 1 + 0.9 * std::sin(0.05 * x) * std::cos(0.07 * y);
            RunningMoments moments;
            for (int i = 0; i < samples; ++i) moments.add(-truth * std::log(1 - noise(draw++)));
            image.set(x, y, 0, static_cast<float>(moments.mean() + bias * truth / 4));
            image.set(x, y, 1, static_cast<float>(moments.standard_error()));
        }
    return image;
}

Image truth_of_skewed_picture() {
    Image image(columns, rows, {"Y"});
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            image.set(x, y, 0, static_cast<float>(1 + 0.9 * std::sin(0.05 * x) * std::cos(0.07 * y)));
    return image;
}

// 50,000 scores: the standard deviation of their mean is 0.0045, and that of their standard deviation about
// 0.004. All bounds are at least 5 of these away from what is expected: a false alarm below 1e-5 in all; the
// seeds are fixed.
TEST(PooledScores, OfSkewedPixelsHaveMeanZeroAndSpreadOne) {
    Image a = skewed_picture(1), truth = truth_of_skewed_picture();
    Comparison r = compare_pictures(measured_picture("a", a), measured_picture("truth", truth));
    ASSERT_EQ(r.pooled.count, 50000u);
    // Plain scores lean by half the skewness, pooled ones by a ninth of that.
    EXPECT_LT(r.z.mean, -0.2);
    EXPECT_NEAR(r.pooled.mean, -0.25 / 9, 0.025);
    EXPECT_NEAR(r.pooled.standard_deviation, 1, 0.03);
    EXPECT_LE(r.pooled.largest,
              3 * r.z.largest); // for the own part is a ninth of the pooled variance at least

    Image b = skewed_picture(2);
    Comparison pair = compare_pictures(measured_picture("a", a), measured_picture("b", b));
    EXPECT_NEAR(pair.pooled.mean, 0, 0.025);
    EXPECT_NEAR(pair.pooled.standard_deviation, 1, 0.03);
}

TEST(PooledScores, SeeABiasThatSkewnessHidesFromPlainOnes) {
    // A quarter of the error of one pixel: about what plain scores lean to the other side.
    Image a = skewed_picture(1, 0.25), truth = truth_of_skewed_picture();
    Comparison r = compare_pictures(measured_picture("a", a), measured_picture("truth", truth));
    EXPECT_LT(std::abs(r.z.mean), 0.05);
    EXPECT_NEAR(r.pooled.mean, 0.25 - 0.25 / 9, 0.03);
    // Errors said to be half of what they are.
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) a.set(x, y, 1, a.value(x, y, 1) / 2);
    EXPECT_NEAR(compare_pictures(measured_picture("a", a), measured_picture("truth", truth))
                    .pooled.standard_deviation,
                2, 0.06);
}

TEST(PooledScores, ExplainWhatSamplesMissed) {
    // Neighbours found a rare light, the pixel in the middle did not and claims to be exact.
    Image a(3, 1, {"Y", "stderr.Y"}), b(3, 1, {"Y"});
    for (int x : {0, 2}) a.set(x, 0, 1, 3);
    b.set(1, 0, 0, 2);
    Comparison r = compare_pictures(measured_picture("a", a), measured_picture("b", b));
    EXPECT_EQ(r.z.unexplained, 1u);
    EXPECT_EQ(r.pooled.unexplained, 0u);
    EXPECT_EQ(r.pooled.count, 3u);
    EXPECT_NEAR(r.pooled.largest, 2 / std::sqrt(6.0), 1e-6);
    // Equal without error: no score, whatever the neighbours say. Not known: none either.
    b.set(1, 0, 0, 0);
    a.set(0, 0, 1, std::numeric_limits<float>::infinity());
    r = compare_pictures(measured_picture("a", a), measured_picture("b", b));
    EXPECT_EQ(r.pooled.equal_without_error, 1u);
    EXPECT_EQ(r.pooled.invalid_errors, 1u);
    EXPECT_EQ(r.pooled.count, 1u);
}

} // namespace
} // namespace montelux
