// The statistical engine itself: accepts what is right, rejects what is slightly wrong.
#include "test/significance.h"
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/math/special.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/z_test.h"

namespace montelux {
namespace {

TEST(ChiSquared, PValuesOfCorrectCodeAreUniform) {
    TestUniforms u(11);
    std::vector<double> p_values;
    for (int run = 0; run < 500; ++run) {
        std::vector<double> observed(30), expected(30, 2000 / 30.0);
        for (int i = 0; i < 2000; ++i) observed[static_cast<std::size_t>(u.next() * 30)] += 1;
        p_values.push_back(chi_squared_test(observed, expected).p_value);
    }
    auto r = kolmogorov_smirnov_test(p_values, [](double p) { return p; });
    EXPECT_TRUE(r.passes(significance)) << r.description;
}

TEST(ChiSquared, PoolsCellsThatExpectLittle) {
    // Three cells of 2 make a pool of 6; the statistic is that of {6: 9, 94: 91}.
    std::vector<double> expected{2, 94, 2, 2}, observed{9, 91, 0, 0};
    auto r = chi_squared_test(observed, expected);
    EXPECT_EQ(r.degrees_of_freedom, 1);
    EXPECT_NEAR(r.statistic, 9 / 6.0 + 9 / 94.0, 1e-12);
    // A last pool that stays small joins the one before it.
    std::vector<double> few{1, 99}, counts{3, 97};
    EXPECT_EQ(chi_squared_test(counts, few).degrees_of_freedom, 0);
}

TEST(ChiSquared, RejectsSamplesWhereTheDensityIsZero) {
    std::vector<double> expected{0, 5000, 5000}, observed{5, 4996, 4999};
    EXPECT_FALSE(chi_squared_test(observed, expected).passes(significance));
    observed = {1, 5000, 4999}; // rounding at an edge is forgiven
    EXPECT_TRUE(chi_squared_test(observed, expected).passes(significance));
    expected = {NAN, 5000, 5000};
    EXPECT_FALSE(chi_squared_test(observed, expected).passes(significance));
}

TEST(IntervalChiSquared, AcceptsRightRejectsSlightlyWrong) {
    auto sample = [](double u) { return std::sqrt(u); };
    auto right = interval_chi_squared_test(
        sample, [](double x) { return 2 * x; }, 0, 1);
    EXPECT_TRUE(right.passes(significance)) << right.description;
    // Exponent 1.03 in place of 1.
    auto wrong = interval_chi_squared_test(
        sample, [](double x) { return 2.03 * std::pow(x, 1.03); }, 0, 1);
    EXPECT_FALSE(wrong.passes(significance)) << wrong.description;
    // Right shape, wrong constant, in either direction.
    auto scaled = [&](double c) {
        return interval_chi_squared_test(
            sample, [c](double x) { return 2 * c * x; }, 0, 1);
    };
    EXPECT_FALSE(scaled(1.02).passes(significance));
    EXPECT_FALSE(scaled(0.98).passes(significance));
}

TEST(IntervalChiSquared, FailuresMustMatchTheMissingDensity) {
    auto sample = [](double u) -> std::optional<double> {
        if (u < 0.25) return std::nullopt;
        return (u - 0.25) / 0.75;
    };
    EXPECT_TRUE(interval_chi_squared_test(
                    sample, [](double) { return 0.75; }, 0, 1)
                    .passes(significance));
    EXPECT_FALSE(interval_chi_squared_test(
                     sample, [](double) { return 0.76; }, 0, 1)
                     .passes(significance));
    EXPECT_FALSE(interval_chi_squared_test(
                     sample, [](double) { return 1.0; }, 0, 1)
                     .passes(significance));
}

TEST(RectangleChiSquared, SeesACorrelationThatMarginalsHide) {
    auto independent = [](Vec2f u) { return u; };
    auto r = rectangle_chi_squared_test(independent, [](Vec2d) { return 1.0; }, {0, 0}, {1, 1});
    EXPECT_TRUE(r.passes(significance)) << r.description;
    auto correlated = [](Vec2d p) { return 1 + 0.2 * (2 * p.x - 1) * (2 * p.y - 1); };
    EXPECT_FALSE(rectangle_chi_squared_test(independent, correlated, {0, 0}, {1, 1}).passes(significance));
}

TEST(SphericalChiSquared, DistinguishesCosineFromUniformAndFindsDiscontinuities) {
    auto cosine = [](Vec2f u) {
        float z = std::sqrt(u.x), r = std::sqrt(1 - u.x), phi = two_pi_f * u.y;
        return Vec3f(r * std::cos(phi), r * std::sin(phi), z);
    };
    auto right = spherical_chi_squared_test(cosine, [](Vec3f w) { return std::max(0.0f, w.z) * inv_pi_f; });
    EXPECT_TRUE(right.passes(significance)) << right.description;
    auto tilted = spherical_chi_squared_test(
        cosine, [](Vec3f w) { return std::max(0.0f, w.z) * inv_pi_f * (1 + 0.1f * w.x); });
    EXPECT_FALSE(tilted.passes(significance));
    auto uniform = spherical_chi_squared_test(cosine, [](Vec3f w) { return w.z > 0 ? inv_two_pi_f : 0.0f; });
    EXPECT_FALSE(uniform.passes(significance));
}

TEST(SphericalChiSquared, NarrowLobeNeedsItsOwnRange) {
    // A cone of half a degree: wrong by a quarter of its width, seen only with cells inside it.
    float versine = 4e-5f;
    auto sample = [&](Vec2f u) {
        float v = versine * u.x, r = std::sqrt(v * (2 - v)), phi = two_pi_f * u.y;
        return Vec3f(r * std::cos(phi), r * std::sin(phi), 1 - v);
    };
    ChiSquaredOptions options;
    options.cells_x = 8;
    options.cos_theta_min = 1 - 1e-4;
    options.samples = 50000;
    auto cone = [](double half_versine) {
        return [=](Vec3f w) { return 1 - w.z < half_versine ? inv_two_pi / half_versine : 0.0; };
    };
    auto right = spherical_chi_squared_test(sample, cone(static_cast<double>(versine)), options);
    EXPECT_TRUE(right.passes(significance)) << right.description;
    EXPECT_FALSE(spherical_chi_squared_test(sample, cone(5e-5), options).passes(significance));
}

TEST(Sidak, SharesTheFalseAlarmRate) {
    double each = sidak_threshold(0.01, 300);
    EXPECT_NEAR(1 - std::pow(1 - each, 300), 0.01, 1e-12);
    EXPECT_FALSE((TestResult{0, 0, NAN, ""}.passes(0.01)));
}

TEST(UnbiasednessTest, FindsASmallBias) {
    TestUniforms u(5);
    RunningMoments m;
    for (int i = 0; i < 100000; ++i) m.add(u.next());
    EXPECT_TRUE(unbiasedness_test(m, 0.5).passes(significance));
    EXPECT_FALSE(unbiasedness_test(m, 0.506).passes(significance));
    EXPECT_TRUE(unbiasedness_test(Estimate::from_moments(m), 0.5).passes(significance));
    EXPECT_FALSE(unbiasedness_test(Estimate::from_moments(m), 0.506).passes(significance));
    RunningMoments constant;
    constant.add(1);
    constant.add(1);
    EXPECT_TRUE(unbiasedness_test(constant, 1).passes(significance));
    EXPECT_FALSE(unbiasedness_test(constant, 1.001).passes(significance));
}

TEST(CalibrationTest, RejectsErrorsThatAreTooSmallOrTooLarge) {
    TestUniforms u(6);
    std::vector<double> z;
    for (int i = 0; i < 4000; ++i) z.push_back(normal_quantile(u.next()));
    EXPECT_TRUE(calibration_test(z).passes(significance)) << calibration_test(z).description;
    for (double factor : {0.85, 1.15}) {
        auto scaled = z;
        for (double& v : scaled) v *= factor;
        EXPECT_FALSE(calibration_test(scaled).passes(significance)) << factor;
    }
}

TEST(KolmogorovSmirnov, RejectsAShift) {
    TestUniforms u(7);
    std::vector<double> x;
    for (int i = 0; i < 20000; ++i) x.push_back(u.next());
    EXPECT_TRUE(kolmogorov_smirnov_test(x, [](double v) { return v; }).passes(significance));
    for (const double shift : {0.02, -0.02})
        EXPECT_FALSE(kolmogorov_smirnov_test(x, [=](double v) { return std::clamp(v - shift, 0.0, 1.0); })
                         .passes(significance))
            << shift;
    // Largest distance between the distribution function and the empirical steps, on either side.
    const std::vector<double> early{0.125, 0.25}, late{0.75, 0.875}, apart{0.375, 0.625};
    const auto distance = [](const std::vector<double>& values) {
        return kolmogorov_smirnov_test(values, [](double v) { return v; }).statistic;
    };
    EXPECT_EQ(distance(early), 0.75);
    EXPECT_EQ(distance(late), 0.75);
    EXPECT_EQ(distance(apart), 0.375);
}

} // namespace
} // namespace montelux
