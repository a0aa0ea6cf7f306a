// Octaves of noise against sums by hand, and what a footprint leaves of them.
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/math/fractal_noise.h"
#include "montelux/mc/math/gradient_noise.h"

namespace montelux {
namespace {

constexpr Point3f place{0.3f, -1.7f, 5.45f};

TEST(FractalNoise, SumsOctaves) {
    EXPECT_EQ(fractal_noise(place, {.octaves = 0}), 0);
    EXPECT_FLOAT_EQ(fractal_noise(place, {.octaves = 1, .roughness = 0.3f}), gradient_noise(place));
    const float a = gradient_noise(place), b = gradient_noise(place * 1.99f),
                c = gradient_noise(place * (1.99f * 1.99f));
    ASSERT_NE(a, b);
    EXPECT_FLOAT_EQ(fractal_noise(place, {.octaves = 3, .roughness = 0.25f}), a + b / 4 + c / 16);
    EXPECT_FLOAT_EQ(turbulence(place, {.octaves = 3, .roughness = 0.25f}),
                    std::abs(a) + std::abs(b) / 4 + std::abs(c) / 16);
}

TEST(FractalNoise, FootprintsLimitOctaves) {
    // Sides of 2^-k leave k - 1 octaves; the longer side counts.
    EXPECT_FLOAT_EQ(unaliased_octaves({0x1p-4f, 0, 0}, {}, 8), 3);
    EXPECT_FLOAT_EQ(unaliased_octaves({}, {0, -0x1p-4f, 0}, 8), 3);
    EXPECT_FLOAT_EQ(unaliased_octaves({0x1p-4f, 0, 0}, {0, 0, 0x1p-6f}, 8), 3);
    EXPECT_FLOAT_EQ(unaliased_octaves({0x1p-4f, 0, 0}, {}, 2), 2);
    EXPECT_EQ(unaliased_octaves({3, 0, 0}, {}, 8), 0);
    EXPECT_EQ(unaliased_octaves({}, {}, 8), 8);
    EXPECT_EQ(unaliased_octaves({NAN, 0, 0}, {NAN, 0, 0}, 8), 8);
    const NoiseOctaves n{.octaves = 8, .roughness = 0.5f};
    EXPECT_FLOAT_EQ(fractal_noise(place, n, {0x1p-4f, 0, 0}), fractal_noise(place, {.octaves = 3}));
    EXPECT_NE(fractal_noise(place, n, {0x1p-4f, 0, 0}), fractal_noise(place, n));
    EXPECT_EQ(fractal_noise(place, n, {4, 0, 0}), 0);
    // Half of the fourth octave is in: the cubic step is 1/2 in the middle.
    const float half = 0.0625f / std::sqrt(2.0f);
    EXPECT_NEAR(fractal_noise(place, n, {half, 0, 0}),
                0.5f * (fractal_noise(place, {.octaves = 3}) + fractal_noise(place, {.octaves = 4})), 1e-6);
    // Aliased octaves of turbulence keep their mean.
    EXPECT_NEAR(turbulence(place, n, {4, 0, 0}), 0.2f * (2 - 0x1p-7f), 1e-6);
}

TEST(FractalNoise, MeanOfAbsoluteNoise) {
    double sum = 0;
    constexpr int n = 60;
    for (int x = 0; x < n; ++x)
        for (int y = 0; y < n; ++y)
            for (int z = 0; z < n; ++z)
                sum += double(std::abs(gradient_noise({static_cast<float>(x) * 1.37f + 0.1f,
                                                       static_cast<float>(y) * 1.41f + 0.2f,
                                                       static_cast<float>(z) * 1.61f + 0.3f})));
    EXPECT_NEAR(sum / (n * n * n), double(mean_absolute_noise), 0.02);
}

} // namespace
} // namespace montelux
