#include "test/near.h"
#include <gtest/gtest.h>

#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/z_test.h"
#include "montelux/spectrum/illuminants.h"
#include "montelux/spectrum/named_spectra.h"
#include "montelux/spectrum/sensor.h"

namespace montelux {
namespace {

TEST(Sensor, WhiteLightGivesWhite) {
    for (const char* name : {"srgb", "dci-p3", "rec2020", "aces2065-1"}) {
        const RgbColorSpace& space = *find_rgb_color_space(name);
        Spectrum light = RgbIlluminantSpectrum(space, {1, 1, 1});
        double scale = 1 / to_photometric(light);
        Vec3d rgb = Sensor(space).integrate_rgb([&](float l) { return light(l) * scale; });
        expect_near(rgb, {1, 1, 1}, 1e-5);
    }
}

TEST(Sensor, ColouredLightsKeepTheirColour) {
    const RgbColorSpace& space = RgbColorSpace::srgb();
    for (Vec3f colour : {Vec3f(17, 12, 4), Vec3f(0.1f, 0, 2), Vec3f(300, 500, 100), Vec3f(0, 0.02f, 0)}) {
        Spectrum light = RgbIlluminantSpectrum(space, colour);
        double scale = 1 / to_photometric(light);
        Vec3d rgb = Sensor().integrate_rgb([&](float l) { return light(l) * scale; });
        expect_near(rgb, Vec3d(colour), 2e-3 * max_component(colour));
    }
}

TEST(Sensor, EstimatesAreUnbiased) {
    const RgbColorSpace& space = RgbColorSpace::srgb();
    Spectrum light = RgbIlluminantSpectrum(space, {1, 1, 1});
    Spectrum paint = RgbAlbedoSpectrum(space, {0.7f, 0.3f, 0.1f});
    float scale = static_cast<float>(1 / to_photometric(light));
    Sensor sensor(space);
    // What nearest lookups estimate: each end of the range counts for half a nanometre.
    Vec3d truth = sensor.integrate_rgb(
        [&](float l) { return (l == 360 || l == 830 ? 0.5 : 1.0) * light(l) * paint(l) * scale; });
    for (bool terminate : {false, true}) {
        TestUniforms uniforms(21);
        RunningMoments moments[3];
        for (int i = 0; i < 300000; ++i) {
            auto w = SampledWavelengths::sample_visible(uniforms.next_float());
            if (terminate) w.terminate_secondary();
            Vec3f rgb = sensor.to_rgb(light.sample(w) * paint.sample(w) * scale, w);
            for (int k = 0; k < 3; ++k) moments[k].add(rgb[k]);
        }
        for (int k = 0; k < 3; ++k) {
            auto r = unbiasedness_test(moments[k], truth[k]);
            EXPECT_TRUE(r.passes(1e-7)) << r.description;
        }
    }
}

TEST(Sensor, WhiteIsExactInExpectationOverAStratifiedSweep) {
    Spectrum light = RgbIlluminantSpectrum(RgbColorSpace::srgb(), {1, 1, 1});
    float scale = static_cast<float>(1 / to_photometric(light));
    Sensor sensor;
    Vec3d sum;
    constexpr int n = 100000;
    for (int i = 0; i < n; ++i) {
        auto w = SampledWavelengths::sample_visible((static_cast<float>(i) + 0.5f) / n);
        sum += Vec3d(sensor.to_rgb(light.sample(w) * scale, w));
    }
    expect_near(sum / n, {1, 1, 1}, 2e-4);
}

TEST(Sensor, ExposureScalesLinearly) {
    Sensor a, b(RgbColorSpace::srgb(), {.exposure_time = 0.5f, .iso = 400});
    EXPECT_FLOAT_EQ(b.imaging_ratio(), 2);
    auto w = SampledWavelengths::sample_visible(0.4f);
    Vec3f x = a.to_rgb(SampledSpectrum(1, 2, 3, 4), w), y = b.to_rgb(SampledSpectrum(1, 2, 3, 4), w);
    for (int k = 0; k < 3; ++k) EXPECT_FLOAT_EQ(y[k], 2 * x[k]);
}

TEST(Sensor, WhiteBalanceMakesItsLightNeutral) {
    for (float temperature : {3200.0f, 5000.0f, 9000.0f}) {
        Sensor sensor(RgbColorSpace::srgb(), {.white_balance = temperature});
        SpectrumTable light = daylight(temperature);
        double scale = 1 / integrate_luminance(light);
        Vec3d rgb = sensor.integrate_rgb([&](float l) { return light(l) * scale; });
        EXPECT_NEAR(rgb.x / rgb.y, 1, 1e-4);
        EXPECT_NEAR(rgb.z / rgb.y, 1, 1e-4);
    }
}

TEST(Sensor, ChromaticAdaptationIsBradfords) {
    // D65 to D50 as printed by Lindbloom, "Chromatic Adaptation" (brucelindbloom.com).
    const double printed[3][3] = {{1.0478112, 0.0228866, -0.0501270},
                                  {0.0295424, 0.9904844, -0.0170491},
                                  {-0.0092345, 0.0150436, 0.7521316}};
    Matrix3 m = chromatic_adaptation({0.31272, 0.32903}, {0.34567, 0.35851});
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) EXPECT_NEAR(m.rows[i][j], printed[i][j], 3e-4);
}

} // namespace
} // namespace montelux
