// Measured BRDFs: tables of a known BRDF give it back; data that make no sense are refused.
#include "test/scene/bsdf_testing.h"
#include "test/scene/measured_brdf_testing.h"
#include <gtest/gtest.h>

#include "montelux/mc/math/error.h"

namespace montelux::testing {
namespace {

const Float4 four_wavelengths{400, 500, 600, 700};

class MeasuredReflector : public ::testing::TestWithParam<std::pair<float, float>> {};
INSTANTIATE_TEST_SUITE_P(MeasuredBrdf, MeasuredReflector,
                         ::testing::Values(std::pair{0.4f, 0.4f}, std::pair{0.7f, 0.7f},
                                           std::pair{0.4f, 0.7f}));

TEST_P(MeasuredReflector, GivesBackWhatWasMeasured) {
    const MeasuredGgx truth{{GetParam().first, GetParam().second}};
    const MeasuredBrdf brdf(measured_ggx(truth));
    EXPECT_EQ(brdf.is_isotropic(), GetParam().first == GetParam().second);
    TestStream stream(5);
    double sum = 0, error = 0;
    int n = 0;
    for (int i = 0; i < 3000; ++i) {
        const Vec3f wo = direction(75 * double(stream.next_1d()), 360 * double(stream.next_1d()));
        const Vec3f wi = direction(75 * double(stream.next_1d()), 360 * double(stream.next_1d()));
        // Both sides reflect alike.
        const float side = i % 2 == 0 ? 1 : -1;
        const BsdfEvaluation e = brdf.evaluate(side * wo, side * wi, four_wavelengths);
        for (int c = 0; c < 4; ++c) {
            const auto exact = double(truth.value(wo, wi, four_wavelengths[c]) * wi.z);
            sum += exact;
            error += std::abs(double(e.f[c]) - exact);
            ++n;
        }
        EXPECT_EQ(brdf.evaluate(wo, -wi, four_wavelengths).f[0], 0);
    }
    // The interpolation of 24 angles and 48^2 normals.
    EXPECT_LT(error / sum, 0.03) << sum / n;
}

TEST_P(MeasuredReflector, SamplesLikeTheLuminance) {
    // With a BRDF proportional to the luminance the weight hardly varies.
    const MeasuredBrdf brdf(measured_ggx({{GetParam().first, GetParam().second}}));
    TestStream stream(6);
    for (double theta : {5.0, 40.0, 70.0}) {
        double sum = 0, squares = 0;
        int n = 0;
        const int tries = 4000;
        for (int i = 0; i < tries; ++i) {
            const auto s = brdf.sample(direction(theta, 30), four_wavelengths, stream.next_2d());
            if (!s) continue;
            sum += double(s->weight[1]);
            squares += double(s->weight[1]) * double(s->weight[1]);
            ++n;
        }
        EXPECT_GT(n, tries * 9 / 10);
        const double mean = sum / n;
        EXPECT_LT(squares / n - mean * mean, 0.05 * mean * mean) << theta;
        EXPECT_NEAR(double(brdf.albedo(direction(theta, 30), four_wavelengths)[1]), sum / tries, 0.05);
    }
}

TEST(MeasuredBrdf, RefusesTablesThatDoNotFit) {
    const MeasuredBrdfData good = measured_ggx({{0.4f, 0.4f}}, 8);
    const auto message = [&](const auto& change) -> std::string {
        MeasuredBrdfData d = good;
        change(d);
        try {
            MeasuredBrdf(std::move(d));
        } catch (const Error& e) {
            return e.what();
        }
        return "";
    };
    EXPECT_EQ(message([](MeasuredBrdfData&) {}), "");
    EXPECT_EQ(message([](MeasuredBrdfData& d) { std::swap(d.theta[1], d.theta[2]); }),
              "measured BRDF: theta_i: expected finite numbers that increase");
    EXPECT_EQ(message([](MeasuredBrdfData& d) { d.wavelengths[0] = NAN; }),
              "measured BRDF: wavelengths: expected finite numbers that increase");
    EXPECT_EQ(message([](MeasuredBrdfData& d) { d.phi.clear(); }),
              "measured BRDF: phi_i: expected finite numbers that increase");
    EXPECT_EQ(message([](MeasuredBrdfData& d) { d.theta.pop_back(); }),
              "measured BRDF: vndf: the size does not fit the numbers of directions and wavelengths");
    EXPECT_EQ(message([](MeasuredBrdfData& d) { d.wavelengths.pop_back(); }),
              "measured BRDF: spectra: the size does not fit the numbers of directions and wavelengths");
    EXPECT_EQ(message([](MeasuredBrdfData& d) { d.ndf.rows = 0; }),
              "measured BRDF: ndf: the size does not fit the numbers of directions and wavelengths");
    EXPECT_EQ(message([](MeasuredBrdfData& d) { d.luminance.values[3] = -1; }),
              "measured BRDF: luminance: a value is negative or not finite");
    EXPECT_EQ(message([](MeasuredBrdfData& d) { d.spectra.values[3] = INFINITY; }),
              "measured BRDF: spectra: a value is not finite");
    EXPECT_EQ(message([](MeasuredBrdfData& d) { d.spectra.values[3] = -0.01f; }), ""); // noise
    EXPECT_EQ(message([](MeasuredBrdfData& d) {
                  d.phi = {0, 0.5f, 1};
              }),
              "measured BRDF: phi_i covers a part of the circle; only isotropic surfaces may");
}

// A black surface, and one without microfacets to see.
TEST(MeasuredBrdf, ReflectsNothing) {
    MeasuredBrdfData d = measured_ggx({{0.4f, 0.4f}}, 8);
    std::fill(d.spectra.values.begin(), d.spectra.values.end(), -0.001f);
    std::fill(d.luminance.values.begin(), d.luminance.values.end(), 0.0f);
    const MeasuredBrdf black(d);
    TestStream stream(7);
    for (int i = 0; i < 100; ++i)
        if (const auto s = black.sample(direction(30), four_wavelengths, stream.next_2d())) {
            EXPECT_EQ(s->weight[0], 0);
            EXPECT_GT(s->pdf, 0);
        }
    std::fill(d.sigma.values.begin(), d.sigma.values.end(), 0.0f);
    const MeasuredBrdf hidden(d);
    EXPECT_FALSE(hidden.sample(direction(30), four_wavelengths, {0.5f, 0.5f}));
    EXPECT_EQ(hidden.evaluate(direction(30), direction(10), four_wavelengths).f[0], 0);
}

} // namespace
} // namespace montelux::testing
