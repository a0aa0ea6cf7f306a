// Hair: each factor of the model integrates to 1, the lobes share the light, nothing is lost without absorption.
#include "test/scene/bsdf_testing.h"
#include <array>
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/stats/moments.h"

namespace montelux::testing {
namespace {

HairBsdf hair(float h, SampledSpectrum sigma_a, float beta_m = 0.3f, float beta_n = 0.3f, float tilt = 2) {
    return HairBsdf::make(h, 1.55f, sigma_a, beta_m, beta_n, tilt);
}

// The mean over the midpoints of n cells of [a, b], times b - a.
template <typename F>
double integral(double a, double b, F&& f, int n = 20000) {
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += f(a + (b - a) * (i + 0.5) / n);
    return sum * (b - a) / n;
}

TEST(Hair, LongitudinalScatteringIsADensity) {
    for (float beta_m : {0.05f, 0.1f, 0.3f, 0.7f, 1.0f})
        for (double theta_o : {-80.0, -20.0, 0.0, 55.0, 89.0}) {
            const float v = hair(0, SampledSpectrum(0), beta_m).variance;
            const double o = theta_o * pi / 180;
            const double total = integral(-pi / 2, pi / 2, [&](double i) {
                return std::cos(i) *
                       static_cast<double>(HairBsdf::longitudinal(
                           static_cast<float>(std::sin(i)), static_cast<float>(std::cos(i)),
                           static_cast<float>(std::sin(o)), static_cast<float>(std::cos(o)), v));
            });
            EXPECT_NEAR(total, 1, 1e-3) << beta_m << ' ' << theta_o;
        }
}

TEST(Hair, AzimuthalScatteringIsADensity) {
    for (float beta_n : {0.05f, 0.3f, 0.7f, 1.0f}) {
        const float scale = hair(0, SampledSpectrum(0), 0.3f, beta_n).scale;
        // Over any whole turn.
        for (double from : {-pi, 0.4, 5 * pi})
            EXPECT_NEAR(integral(from, from + 2 * pi,
                                 [&](double phi) {
                                     return double(HairBsdf::azimuthal(static_cast<float>(phi), scale));
                                 }),
                        1, 1e-4)
                << beta_n;
    }
}

TEST(Hair, LobesShareTheLight) {
    for (float h : {-1.0f, -0.7f, 0.0f, 0.3f, 0.999f})
        for (double theta : {0.0, 30.0, 85.0}) {
            const auto s = static_cast<float>(std::sin(theta * pi / 180)),
                       c = static_cast<float>(std::cos(theta * pi / 180));
            const auto clear = hair(h, SampledSpectrum(0)).attenuation(s, c);
            double sum = 0;
            for (const SampledSpectrum& a : clear) sum += double(a[0]);
            EXPECT_NEAR(sum, 1, 1e-5) << h << ' ' << theta;
            // Absorption leaves the reflection alone and dims the lobes by the ways through the hair.
            const auto dark = hair(h, SampledSpectrum(0.2f)).attenuation(s, c);
            EXPECT_EQ(dark[0], clear[0]);
            if (!(clear[1][0] > 1e-3f)) continue;
            const double through = double(dark[1][0] / clear[1][0]);
            EXPECT_LT(through, 1);
            EXPECT_NEAR(double(dark[2][0]), double(clear[2][0]) * through * through, 1e-5);
        }
    // Straight through the axis: the Fresnel formula at normal incidence, exp(-2 sigma_a).
    const float f = (0.55f / 2.55f) * (0.55f / 2.55f);
    const auto a = hair(0, SampledSpectrum(0.5f)).attenuation(0, 1);
    EXPECT_NEAR(a[0][0], f, 1e-6f);
    EXPECT_NEAR(a[1][0], (1 - f) * (1 - f) * std::exp(-1.0f), 1e-6f);
}

TEST(Hair, WhiteHairLosesNothing) {
    TestStream stream(3);
    for (float h : {-0.9f, 0.0f, 0.5f})
        for (float beta : {0.1f, 0.4f, 0.9f}) {
            const HairBsdf b = hair(h, SampledSpectrum(0), beta, beta);
            for (Vec3f wo : {direction(20, 30), direction(75, 200), direction(120, 100)}) {
                // Each sample has weight 1, and the integral of the value is 1.
                RunningMoments uniform;
                for (int i = 0; i < 20000; ++i) {
                    if (auto s = b.sample(wo, TransportMode::radiance, stream)) {
                        ASSERT_NEAR(s->weight[0], 1, 1e-4f);
                    }
                    const Vec2f u = stream.next_2d();
                    const float z = 1 - 2 * u.x, r = std::sqrt(std::max(0.0f, 1 - z * z));
                    const Vec3f wi{r * std::cos(two_pi_f * u.y), r * std::sin(two_pi_f * u.y), z};
                    uniform.add(double(b.evaluate(wo, wi, TransportMode::radiance, stream).f[0]) * 4 * pi);
                }
                EXPECT_NEAR(uniform.mean(), 1, 6 * uniform.standard_error() + 1e-4) << h << ' ' << beta;
                EXPECT_NEAR(b.albedo(wo)[0], 1, 1e-5f);
            }
        }
}

// The reflection of a smooth hair hit at offset h leaves as from a cylinder: turned by -2 asin(h), and along
// the hair by twice the tilt.
TEST(Hair, ReflectsLikeACylinder) {
    const float h = 0.5f, tilt = 3;
    const HairBsdf b = hair(h, SampledSpectrum(1000.0f), 0.05f, 0.05f, tilt); // only R is left
    const Vec3f wo = {std::sin(0.3f), 0, std::cos(0.3f)};                     // phi = 90 degrees
    FixedStream stream({}, 0);
    const auto value = [&](double theta, double phi) {
        const auto t = static_cast<float>(theta), p = static_cast<float>(phi);
        return b
            .evaluate(wo, {std::sin(t), std::cos(t) * std::cos(p), std::cos(t) * std::sin(p)},
                      TransportMode::radiance, stream)
            .f[0];
    };
    // theta_o is turned by -2 tilt.
    const double theta = -(0.3 - 2 * double(tilt) * pi / 180), phi = pi / 2 - 2 * std::asin(0.5);
    for (double d : {-0.05, 0.05}) {
        EXPECT_GT(value(theta, phi), value(theta + d, phi));
        EXPECT_GT(value(theta, phi), value(theta, phi + d));
    }
}

// Each lobe of a smooth clear hair is brightest where Snell's law turns it about the hair, and where the scales turn it
// along the hair: by -2 tilts after the reflection, by 1 straight through, by 4 with one internal reflection.
TEST(Hair, ScalesTiltEachLobe) {
    const double h = 0.5, eta = 1.55, tilt = 3 * pi / 180, theta_o = 0.3;
    const HairBsdf b = hair(static_cast<float>(h), SampledSpectrum(0), 0.05f, 0.05f, 3);
    const Vec3f wo = {std::sin(0.3f), 0, std::cos(0.3f)}; // phi = 90 degrees
    FixedStream stream({}, 0);
    const auto value = [&](double theta, double phi) {
        const Vec3d wi{std::sin(theta), std::cos(theta) * std::cos(phi), std::cos(theta) * std::sin(phi)};
        return b.evaluate(wo, Vec3f(wi), TransportMode::radiance, stream).f[0];
    };
    const double sine = std::sin(theta_o), modified = std::sqrt(eta * eta - sine * sine) / std::cos(theta_o);
    const double gamma_o = std::asin(h), gamma_t = std::asin(h / modified);
    const std::array<double, 3> tilts{-2, 1, 4};
    for (std::size_t p = 0; p < tilts.size(); ++p) {
        const double k = static_cast<double>(p);
        const double theta = -(theta_o + tilts[p] * tilt),
                     phi = pi / 2 + 2 * k * gamma_t - 2 * gamma_o + k * pi;
        for (double d : {-0.05, 0.05}) {
            EXPECT_GT(value(theta, phi), value(theta + d, phi)) << p;
            EXPECT_GT(value(theta, phi), value(theta, phi + d)) << p;
        }
    }
}

TEST(Hair, AbsorptionOfAReflectance) {
    // Equation 9 of Chiang et al. at beta_n = 0: (ln C / 5.969)^2.
    const SampledSpectrum s = HairBsdf::sigma_a_of_reflectance(SampledSpectrum(1, 0.5f, 0.1f, 0), 0);
    EXPECT_EQ(s[0], 0);
    EXPECT_NEAR(s[1], 0.013485f, 1e-6f);
    EXPECT_NEAR(s[2], 0.148806f, 1e-5f);
    EXPECT_TRUE(std::isfinite(s[3]));
}

} // namespace
} // namespace montelux::testing
