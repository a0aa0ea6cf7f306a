#include <gtest/gtest.h>

#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/z_test.h"
#include "montelux/spectrum/cie.h"
#include "montelux/spectrum/wavelengths.h"

namespace montelux {
namespace {

TEST(Wavelengths, EveryLaneFollowsTheVisibleDensity) {
    for (int lane = 0; lane < 4; ++lane) {
        auto r = interval_chi_squared_test(
            [&](double u) {
                // The largest double below 1 must not become the float 1.
                return SampledWavelengths::sample_visible(std::min(static_cast<float>(u), one_minus_epsilon))
                    .lambda[lane];
            },
            [](double x) { return SampledWavelengths::visible_pdf(static_cast<float>(x)); }, 360, 830,
            {.samples = 200000, .cells_x = 200, .seed = 7});
        EXPECT_TRUE(r.passes(1e-6)) << r.description;
    }
}

TEST(Wavelengths, ReportedDensityIsThatOfTheWavelength) {
    for (int i = 0; i < 1000; ++i) {
        auto w = SampledWavelengths::sample_visible(static_cast<float>(i) / 1000);
        for (int k = 0; k < 4; ++k) {
            EXPECT_GE(w.lambda[k], lambda_min);
            EXPECT_LE(w.lambda[k], lambda_max);
            EXPECT_NEAR(w.pdf[k] / SampledWavelengths::visible_pdf(w.lambda[k]), 1, 2e-5);
        }
    }
}

TEST(Wavelengths, VisibleDensityIntegratesToOne) {
    double sum = 0;
    constexpr int n = 100000;
    for (int i = 0; i < n; ++i)
        sum += SampledWavelengths::visible_pdf(360 + 470 * (static_cast<float>(i) + 0.5f) / n) * 470 / n;
    EXPECT_NEAR(sum, 1, 1e-5);
    EXPECT_EQ(SampledWavelengths::visible_pdf(359.9f), 0);
    EXPECT_EQ(SampledWavelengths::visible_pdf(830.1f), 0);
}

TEST(Wavelengths, LanesAreStratified) {
    // One of the four lies in each quarter of the distribution, whatever u is.
    double edges[5] = {360, 479.1541, 545.9030, 616.8562, 830};
    for (int i = 0; i < 997; ++i) {
        auto w = SampledWavelengths::sample_visible(static_cast<float>(i) / 997);
        int count[4] = {0, 0, 0, 0};
        for (int k = 0; k < 4; ++k)
            for (int q = 0; q < 4; ++q)
                if (w.lambda[k] >= edges[q] - 1e-3 && w.lambda[k] < edges[q + 1] - 1e-3) ++count[q];
        for (int q = 0; q < 4; ++q) EXPECT_EQ(count[q], 1) << i;
    }
}

TEST(Wavelengths, UniformSamplingCoversItsRange) {
    auto w = SampledWavelengths::sample_uniform(0.6f, 400, 800);
    EXPECT_FLOAT_EQ(w.lambda[0], 640);
    EXPECT_FLOAT_EQ(w.lambda[1], 740);
    EXPECT_FLOAT_EQ(w.lambda[2], 440);
    EXPECT_FLOAT_EQ(w.lambda[3], 540);
    for (int k = 0; k < 4; ++k) EXPECT_FLOAT_EQ(w.pdf[k], 1.0f / 400);
}

TEST(Wavelengths, TerminationKeepsTheHeroAtAQuarterOfItsDensity) {
    auto w = SampledWavelengths::sample_visible(0.3f);
    float hero = w.pdf[0];
    EXPECT_FALSE(w.secondary_terminated());
    w.terminate_secondary();
    EXPECT_TRUE(w.secondary_terminated());
    EXPECT_EQ(w.pdf, SampledSpectrum(0.25f * hero, 0, 0, 0));
    w.terminate_secondary();
    EXPECT_EQ(w.pdf[0], 0.25f * hero);
}

// The mean of f / pdf estimates the integral of f, with four wavelengths and with the hero alone.
TEST(Wavelengths, EstimatesOfIntegralsAreUnbiased) {
    auto f = [](float lambda) {
        double z = (lambda - 600) / 40;
        return std::exp(-0.5 * z * z);
    };
    double truth = 40 * std::sqrt(2 * pi); // the tails outside the range are below 1e-8
    for (bool terminate : {false, true}) {
        TestUniforms uniforms(11);
        RunningMoments moments;
        for (int i = 0; i < 200000; ++i) {
            auto w = SampledWavelengths::sample_visible(uniforms.next_float());
            if (terminate) w.terminate_secondary();
            double sum = 0;
            for (int k = 0; k < 4; ++k)
                if (w.pdf[k] > 0) sum += f(w.lambda[k]) / w.pdf[k] / 4;
            moments.add(sum);
        }
        auto r = unbiasedness_test(moments, truth);
        EXPECT_TRUE(r.passes(1e-6)) << r.description;
    }
}

} // namespace
} // namespace montelux
