// Sensors of cameras: their tables, the matrix to XYZ, and colours of known surfaces.
#include "test/near.h"
#include <gtest/gtest.h>

#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/z_test.h"
#include "montelux/spectrum/camera_sensors.h"
#include "montelux/spectrum/illuminants.h"
#include "montelux/spectrum/named_spectra.h"
#include "montelux/spectrum/sensor.h"

namespace montelux {
namespace {

// CIE 1976 L*a*b* of linear sRGB, relative to white (1, 1, 1).
Vec3d lab_of(Vec3d rgb) {
    const Vec3d xyz = RgbColorSpace::srgb().rgb_from_xyz().inverse() * rgb;
    const Vec3d white = RgbColorSpace::srgb().rgb_from_xyz().inverse() * Vec3d{1, 1, 1};
    const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; };
    const double x = f(xyz.x / white.x), y = f(xyz.y / white.y), z = f(xyz.z / white.z);
    return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

TEST(CameraSensors, TablesAreInOrder) {
    const auto& names = sensor_names();
    ASSERT_EQ(names.size(), 18u);
    EXPECT_EQ(names[0], cie_sensor);
    EXPECT_TRUE(std::is_sorted(names.begin() + 1, names.end()));
    for (const std::string_view name : names) {
        if (name == cie_sensor) continue;
        const auto camera = find_camera_sensor(name);
        ASSERT_TRUE(camera) << name;
        EXPECT_FLOAT_EQ(camera->g.max_value(), 1) << name;
        // Red, green and blue peak where they should.
        const auto peak = [](const SpectrumTable& t) {
            return 360 + (std::max_element(t.values().begin(), t.values().end()) - t.values().begin());
        };
        EXPECT_TRUE(peak(camera->r) >= 580 && peak(camera->r) <= 620) << name << peak(camera->r);
        EXPECT_TRUE(peak(camera->g) >= 510 && peak(camera->g) <= 550) << name << peak(camera->g);
        EXPECT_TRUE(peak(camera->b) >= 440 && peak(camera->b) <= 480) << name << peak(camera->b);
        EXPECT_EQ(camera->g(375), 0);
        EXPECT_EQ(camera->g(725), 0);
    }
    EXPECT_FALSE(find_camera_sensor("cie1931"));
    EXPECT_FALSE(find_camera_sensor("kodak"));
    EXPECT_THROW(Sensor(RgbColorSpace::srgb(), {.name = "nikon_d811"}), Error);
}

// Where the responses are sums of the CIE's matching functions the matrix undoes them, with no error left.
TEST(CameraSensors, MatrixOfALinearObserverIsItsInverse) {
    const Matrix3 mix{{{{0.6, 0.3, 0.05}, {0.2, 0.9, 0.1}, {0.02, 0.1, 0.7}}}};
    CameraSensor observer;
    const auto channel = [&](int k) {
        return SpectrumTable::from([&](float l) {
            const Vec3d v = mix * cie_xyz(static_cast<int>(l - lambda_min));
            return static_cast<float>(v[k]);
        });
    };
    observer.r = channel(0);
    observer.g = channel(1);
    observer.b = channel(2);
    const SpectrumTable white = illuminant_d65();
    const Matrix3 m = xyz_from_camera(observer, white, white), inverse = mix.inverse();
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) EXPECT_NEAR(m.rows[i][j], inverse.rows[i][j], 1e-5);
}

// It depends on the colours of both, not on how strong they are.
TEST(CameraSensors, MatrixDoesNotDependOnTheStrengthOfTheLight) {
    const CameraSensor camera = *find_camera_sensor("canon_eos_5d");
    const SpectrumTable light = daylight(5000), white = illuminant_d65();
    const auto stronger = [](const SpectrumTable& t, float by) {
        return SpectrumTable::from([&](float l) { return by * t(l); });
    };
    const Matrix3 m = xyz_from_camera(camera, light, white);
    for (const Matrix3& other : {xyz_from_camera(camera, stronger(light, 3), white),
                                 xyz_from_camera(camera, light, stronger(white, 3))})
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) EXPECT_NEAR(other.rows[i][j], m.rows[i][j], 1e-5);
}

// Neutral surfaces under the light for which the sensor is balanced are grey with the right luminance; all patches lie
// within the error that three channels of real cameras leave.
TEST(CameraSensors, PatchesUnderTheBalancedLight) {
    for (const std::string_view name : sensor_names()) {
        for (const float temperature : {0.0f, 5000.0f, 6500.0f}) {
            if (temperature == 0 && name == cie_sensor) continue;
            const Sensor sensor(RgbColorSpace::srgb(),
                                {.white_balance = temperature, .name = std::string(name)});
            const SpectrumTable light = daylight(temperature > 0 ? temperature : 6500);
            const double scale = 1 / integrate_luminance(light);
            const Sensor eye;
            const SpectrumTable white = RgbColorSpace::srgb().illuminant();
            const double white_scale = 1 / integrate_luminance(white);
            double sum = 0, largest = 0;
            for (std::size_t i = 0; i < 24; ++i) {
                const SpectrumTable& patch = color_checker_patches()[i];
                const Vec3d got = sensor.integrate_rgb([&](float l) { return patch(l) * light(l) * scale; });
                const Vec3d truth =
                    eye.integrate_rgb([&](float l) { return patch(l) * white(l) * white_scale; });
                const double difference = length(lab_of(got) - lab_of(truth));
                sum += difference;
                largest = std::max(largest, difference);
                if (i >= 18) { // the row of greys
                    expect_near(got, truth, 0.03 * (truth.y + 0.02));
                }
            }
            EXPECT_LT(sum / 24, 2.5) << name << ' ' << temperature;
            EXPECT_LT(largest, 7) << name << ' ' << temperature;
        }
    }
}

TEST(CameraSensors, ExposureAndScaleAreThoseOfTheObserver) {
    Sensor one(RgbColorSpace::srgb(), {.name = "canon_eos_5d"});
    Sensor two(RgbColorSpace::srgb(), {.exposure_time = 0.5f, .iso = 400, .name = "canon_eos_5d"});
    const SpectrumTable light = daylight(6500);
    const double scale = 1 / integrate_luminance(light);
    const Vec3d a = one.integrate_rgb([&](float l) { return light(l) * scale; });
    const Vec3d b = two.integrate_rgb([&](float l) { return light(l) * scale; });
    expect_near(b, 2.0 * a, 1e-6);
    EXPECT_NEAR(dot(a, RgbColorSpace::srgb().luminance_weights()), 1, 0.02);
}

TEST(CameraSensors, EstimatesAreUnbiased) {
    const Sensor sensor(RgbColorSpace::srgb(), {.white_balance = 5000, .name = "sony_ilce_9"});
    const SpectrumTable light = daylight(4000);
    const auto scale = static_cast<float>(1 / integrate_luminance(light));
    const Vec3d truth = sensor.integrate_rgb([&](float l) { return light(l) * scale; });
    TestUniforms uniforms(5);
    RunningMoments moments[3];
    for (int i = 0; i < 100000; ++i) {
        const auto w = SampledWavelengths::sample_visible(uniforms.next_float());
        const Vec3f rgb = sensor.to_rgb(light.sample(w) * scale, w);
        for (int k = 0; k < 3; ++k) moments[k].add(rgb[k]);
    }
    for (int k = 0; k < 3; ++k) {
        const auto r = unbiasedness_test(moments[k], truth[k]);
        EXPECT_TRUE(r.passes(1e-8)) << r.description;
    }
}

} // namespace
} // namespace montelux
