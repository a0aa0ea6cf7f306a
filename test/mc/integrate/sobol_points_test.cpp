#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/integrate/quasi.h"
#include "montelux/mc/integrate/sobol_points.h"
#include "montelux/mc/stats/z_test.h"

namespace montelux {
namespace {

const auto product = [](const std::array<double, 4>& x) {
    double y = 1;
    for (double v : x) y *= pi / 2 * std::sin(pi * v);
    return y;
};
const ProductDistribution cube{UniformDistribution(), UniformDistribution(), UniformDistribution(),
                               UniformDistribution()};

Estimate run(std::uint64_t seed, std::uint64_t points) {
    return randomised_quasi_monte_carlo(product, cube, ScrambledSobolPoints<4>(seed),
                                        {.points = points, .replicates = 8});
}

TEST(ScrambledSobolPoints, UnbiasedWithAnHonestError) {
    RunningMoments values, squared_errors;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        Estimate e = run(seed, 128);
        EXPECT_EQ(e.evaluations, 1024u);
        values.add(e.value);
        squared_errors.add(e.standard_error * e.standard_error);
    }
    auto bias = unbiasedness_test(values, 1);
    EXPECT_TRUE(bias.passes(1e-6)) << bias.description;
    // The squared standard error is unbiased for the variance that the seeds show; that variance is itself
    // known to sqrt(2 / 400), five of which are 35%.
    EXPECT_NEAR(squared_errors.mean() / values.variance(), 1, 0.4);
}

TEST(ScrambledSobolPoints, ErrorFallsFasterThanOneOverN) {
    auto deviation = [](std::uint64_t points) {
        RunningMoments values;
        for (std::uint64_t seed = 0; seed < 100; ++seed) values.add(run(seed, points).value);
        return values.standard_deviation();
    };
    double slope = std::log(deviation(2048) / deviation(128)) / std::log(16.0);
    EXPECT_LT(slope, -1) << "random points would give -1/2";
}

TEST(ScrambledSobolPoints, ReplicatesDiffer) {
    ScrambledSobolPoints<2> points(1);
    EXPECT_NE(points(5, 0), points(5, 1));
    EXPECT_NE(points(5, 0)[0], points(5, 0)[1]);
    EXPECT_EQ(points(5, 3), ScrambledSobolPoints<2>(1)(5, 3));
}

} // namespace
} // namespace montelux
