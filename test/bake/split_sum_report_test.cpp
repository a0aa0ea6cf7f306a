// The split sum's report: where both sides are known, and what its picture holds. False alarms: 1e-5 for the 18 values
// at five standard errors, 2e-6 for the 18 biases at six errors that are estimated from 64 orientations (Student's t).
#include "test/bake/bake_testing.h"
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <string>

#include "montelux/bake/brdf_table.h"
#include "montelux/bake/split_sum_report.h"

namespace montelux {
namespace {

Image constant_map(const Vec3d& radiance) {
    Image image(32, 16, {"R", "G", "B"});
    const std::array<double, 3> values{radiance.x, radiance.y, radiance.z};
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            for (int c = 0; c < 3; ++c)
                image.set(x, y, c, static_cast<float>(values[static_cast<std::size_t>(c)]));
    return image;
}

// Under constant light both sides equal its radiance times F0 * scale + bias.
TEST(SplitSumReport, IsExactUnderConstantLight) {
    const EnvironmentMap map(constant_map({3, 3, 3}), EnvironmentLayout::equirectangular);
    constexpr int size = 20;
    BrdfTableSettings table_settings;
    table_settings.size = size;
    const Image table = brdf_table(table_settings);
    SplitSumSettings settings;
    settings.roughness = {0.325, 0.625, 0.975};
    settings.n_dot_v = {0.125, 0.525, 0.975};
    settings.orientations = 64;
    settings.sphere_size = 0;
    const SplitSumReport report = split_sum_report(map, settings);
    ASSERT_EQ(report.rows.size(), 18u);
    for (const SplitSumRow& row : report.rows) {
        const int x = static_cast<int>(row.n_dot_v * size), y = static_cast<int>(row.roughness * size);
        const double truth = 3 * (row.f0 * table.value(x, y, 0) + table.value(x, y, 1));
        const std::string where = std::to_string(row.roughness) + ", " + std::to_string(row.n_dot_v) + ", " +
                                  std::to_string(row.f0);
        // Each orientation has an error of at most a percent, relative to the radiance of the map if that is larger.
        const double error = settings.target_error * std::max(truth, 3.0) / std::sqrt(settings.orientations);
        EXPECT_NEAR(row.full, truth, 5 * error) << where;
        EXPECT_NEAR(row.bias, 0, 6 * row.bias_error + 1e-3) << where;
    }
}

// Rows of spheres show the integral, the split sum and their absolute difference, whose error combines both.
TEST(SplitSumReport, ErrorsOfTheDifferenceAreThoseOfBothSides) {
    const EnvironmentMap map(random_map(32, 16), EnvironmentLayout::equirectangular);
    SplitSumSettings settings;
    settings.roughness = {0.4, 0.9};
    settings.n_dot_v = {0.5};
    settings.orientations = 2;
    settings.sphere_size = 8;
    settings.samples_max = 4096;
    const Image spheres = split_sum_report(map, settings).spheres;
    const int size = settings.sphere_size;
    ASSERT_EQ(spheres.width(), 2 * size);
    ASSERT_EQ(spheres.height(), 3 * size);
    int seen = 0;
    for (const std::string channel : {"R", "G", "B"}) {
        const int value = *spheres.find_channel(channel), error = *spheres.find_channel("stderr." + channel);
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < 2 * size; ++x) {
                const float full = spheres.value(x, y, value), split = spheres.value(x, size + y, value);
                const float of_full = spheres.value(x, y, error),
                            of_split = spheres.value(x, size + y, error);
                EXPECT_NEAR(spheres.value(x, 2 * size + y, value), std::abs(full - split),
                            1e-5f * (full + split));
                EXPECT_NEAR(spheres.value(x, 2 * size + y, error), std::hypot(of_full, of_split),
                            1e-5f * (of_full + of_split));
                seen += of_full > 0 && of_split > 0 && of_full != of_split;
            }
    }
    EXPECT_GT(seen, 3 * size * size);
}

} // namespace
} // namespace montelux
