#include "test/bake/bake_testing.h"
#include <array>

#include "montelux/bake/cell_estimate.h"
#include "montelux/bake/cube_frame.h"
#include "montelux/mc/stats/moments.h"

namespace montelux {
namespace {

// Many estimates of one texel by a number of samples, each beside the integral.
struct Estimates {
    Moments3 values;
    Vec3d expected, mean_squared_error, within_two; // of the errors claimed; share of estimates
};
Estimates many_estimates(const Image& image, Vec3d n, std::uint64_t samples, int seeds) {
    const EnvironmentMap map(image, EnvironmentLayout::equirectangular);
    const RadialKernel kernel = RadialKernel::ggx(0.6);
    TexelTarget target;
    target.target_error = 0;
    target.samples = samples;
    Estimates all;
    all.expected = TexelPoints(image, 8).sum(
        [&](Vec3d l) { return static_cast<double>(kernel(static_cast<float>(1 - dot(n, l)))); });
    CellEstimator cells(map, kernel);
    for (int seed = 0; seed < seeds; ++seed) {
        const TexelEstimate e = cells.estimate(Vec3f(CubeFrame{}.to_map(n)), target, hash_key(seed, 3));
        EXPECT_LE(e.samples, samples);
        all.values.add(e.value);
        all.mean_squared_error += multiply(e.standard_error, e.standard_error) * (1.0 / seeds);
        for (int c = 0; c < 3; ++c)
            all.within_two[c] +=
                (std::abs(e.value[c] - all.expected[c]) < 2 * e.standard_error[c]) / double(seeds);
    }
    return all;
}

const std::array<Vec3d, 3> directions{normalize(Vec3d{0, 0, 1}), normalize(Vec3d{1, 0.2, 0}),
                                      normalize(Vec3d{-0.3, -1, 0.2})};

// So few cells that the lobe varies much within them, and what is drawn in them matters: the mean of many
// estimates is the integral, and the errors are those of few degrees of freedom, wider than the spread. Nine
// means within five errors: a false alarm in 200,000.
TEST(CellEstimator, UnbiasedWithFewSamples) {
    const Image image = random_map(64, 32, 300);
    for (Vec3d n : directions) {
        const Estimates all = many_estimates(image, n, 24, 8000);
        for (int c = 0; c < 3; ++c) {
            EXPECT_LT(std::abs(all.values.mean(c) - all.expected[c]), 5 * all.values.standard_error(c))
                << all.expected[c];
            EXPECT_GT(all.mean_squared_error[c], 1.1 * all.values.variance(c));
            EXPECT_LT(all.mean_squared_error[c], 2.5 * all.values.variance(c));
        }
    }
}

// At an error of some per cent the truth lies within two errors as often as it should; shares have an error
// of 0.0039, so that one of nine leaves its bounds with 3e-8.
TEST(CellEstimator, CalibratedWithSomeHundredSamples) {
    const Image image = random_map(64, 32, 300);
    for (Vec3d n : directions) {
        const Estimates all = many_estimates(image, n, 300, 3000);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(all.within_two[c], 0.953, 0.023);
            EXPECT_NEAR(all.mean_squared_error[c] / all.values.variance(c), 1.1, 0.17);
        }
    }
}

} // namespace
} // namespace montelux
