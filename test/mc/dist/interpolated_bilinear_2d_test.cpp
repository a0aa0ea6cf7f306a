// Bilinear densities interpolated in two parameters: sampling against the density, its inverse, knots.
#include "test/mc/dist/message_of.h"
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "montelux/mc/dist/interpolated_bilinear_2d.h"
#include "montelux/mc/stats/moments.h"

namespace montelux {
namespace {

constexpr std::uint32_t columns = 5, rows = 4;
const std::vector<float> first_knots{-1, 0, 2}, second_knots{0, 1};

// Random densities with zeros, a zero row and, at the last entry, none at all.
InterpolatedBilinear2D random_density() {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform(0, 1);
    std::vector<float> values(6 * columns * rows);
    for (float& v : values) v = std::max(uniform(random) - 0.2f, 0.0f);
    std::fill_n(values.begin() + columns, columns, 0.0f);
    std::fill_n(values.end() - columns * rows, columns * rows, 0.0f);
    return {6, columns, rows, values};
}

TEST(InterpolatedBilinear2D, WeightsOfKnots) {
    const auto weights = [](float a, float b) {
        const InterpolationWeights w = interpolation_weights(first_knots, second_knots, a, b);
        std::vector<float> all(6, 0.0f);
        for (std::size_t k = 0; k < w.count; ++k) all[w.entry[k]] += w.weight[k];
        return all;
    };
    EXPECT_EQ(weights(-5, 0), (std::vector<float>{1, 0, 0, 0, 0, 0}));
    EXPECT_EQ(weights(5, 7), (std::vector<float>{0, 0, 0, 0, 0, 1}));
    EXPECT_EQ(weights(0, 0.25f), (std::vector<float>{0, 0, 0.75f, 0.25f, 0, 0}));
    EXPECT_EQ(weights(0.5f, 0.5f), (std::vector<float>{0, 0, 0.375f, 0.375f, 0.125f, 0.125f}));
    EXPECT_EQ(weights(NAN, NAN), (std::vector<float>{1, 0, 0, 0, 0, 0}));
    const InterpolationWeights one = interpolation_weights({3}, {4}, 9, 9);
    EXPECT_EQ(one.count, 1u);
    EXPECT_EQ(one.entry[0], 0u);
    EXPECT_EQ(one.weight[0], 1);
}

TEST(InterpolatedBilinear2D, SamplesFollowTheDensityAndInvert) {
    const InterpolatedBilinear2D d = random_density();
    std::mt19937 random(2);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (Vec2f parameters : {Vec2f{-1, 0}, Vec2f{-0.3f, 0.7f}, Vec2f{1.5f, 1}, Vec2f{2, 1}}) {
        const InterpolationWeights at =
            interpolation_weights(first_knots, second_knots, parameters.x, parameters.y);
        // Over each of 60 x 60 squares the number of samples is that of the density's integral (midpoints of
        // squares of a fifteenth and a twentieth of a cell).
        constexpr int n = 60, samples = 400000;
        std::vector<double> counts(n * n), expected(n * n);
        double total = 0;
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const Vec2f p{(static_cast<float>(i) + 0.5f) / n, (static_cast<float>(j) + 0.5f) / n};
                expected[static_cast<std::size_t>(j * n + i)] = double(d.pdf(at, p)) / (n * n);
                total += double(d.pdf(at, p)) / (n * n);
            }
        EXPECT_NEAR(total, 1, 1e-5);
        for (int k = 0; k < samples; ++k) {
            const Vec2f u{uniform(random), uniform(random)};
            const auto s = d.sample(at, u);
            ASSERT_GE(s.p.x, 0);
            ASSERT_LE(s.p.x, 1);
            ASSERT_GE(s.p.y, 0);
            ASSERT_LE(s.p.y, 1);
            ASSERT_NEAR(s.pdf, d.pdf(at, s.p), 1e-4f * s.pdf + 1e-4f);
            const auto back = d.invert(at, s.p);
            // Where the density is small the place in u is well defined, that in p is not.
            ASSERT_NEAR(back.p.x, u.x, 1e-4f + 1e-5f / std::max(s.pdf, 1e-2f));
            ASSERT_NEAR(back.p.y, u.y, 1e-4f);
            ASSERT_NEAR(back.pdf, s.pdf, 1e-4f * s.pdf + 1e-4f);
            counts[static_cast<std::size_t>(std::min(static_cast<int>(s.p.y * n), n - 1) * n +
                                            std::min(static_cast<int>(s.p.x * n), n - 1))] += 1;
        }
        // A chi-squared statistic of about 3600 degrees of freedom; 7 standard deviations.
        double chi = 0;
        int degrees = -1;
        for (std::size_t k = 0; k < counts.size(); ++k) {
            const double mean = expected[k] * samples;
            if (mean < 5) {
                EXPECT_LT(counts[k], 30);
                continue;
            }
            chi += (counts[k] - mean) * (counts[k] - mean) / mean;
            ++degrees;
        }
        EXPECT_LT(chi, degrees + 7 * std::sqrt(2.0 * degrees)) << parameters.x;
        EXPECT_GT(degrees, 2000);
    }
}

TEST(InterpolatedBilinear2D, IsTheMeanOfItsEntries) {
    const InterpolatedBilinear2D d = random_density();
    const auto at = [&](float a, float b) {
        return d.pdf(interpolation_weights(first_knots, second_knots, a, b), {0.37f, 0.81f});
    };
    EXPECT_NEAR(at(-0.25f, 0), 0.25f * at(-1, 0) + 0.75f * at(0, 0), 1e-5f);
    EXPECT_NEAR(at(-1, 0.5f), 0.5f * (at(-1, 0) + at(-1, 1)), 1e-5f);
    EXPECT_EQ(at(2, 1), 1); // the entry of zeros
}

TEST(InterpolatedBilinear2D, RefusesBadTables) {
    EXPECT_EQ(message_of([] {
                  InterpolatedBilinear2D(1, 1, 2, {1, 1});
              }),
              "InterpolatedBilinear2D: expected at least 2 columns and 2 rows");
    EXPECT_EQ(message_of([] {
                  InterpolatedBilinear2D(1, 2, 2, {1, 1});
              }),
              "InterpolatedBilinear2D: found 2 values; expected 1 * 2 * 2");
    EXPECT_NE(message_of([] { InterpolatedBilinear2D(1, 2, 2, {1, 1, -1, 1}); }), "");
}

} // namespace
} // namespace montelux
