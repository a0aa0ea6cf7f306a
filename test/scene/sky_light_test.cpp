// The lights of a sky: directions follow their densities, samples are what rays find, and both give the
// ground the irradiance of the model. Chi-squared tests at 1e-8 each, sums at 5.5 standard errors (4e-8):
// below 1e-6 for the file.
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/scene/light/light_sampling.h"
#include "montelux/scene/light/sky/sky_map.h"
#include "montelux/scene/scene_tables.h"

namespace montelux {
namespace {

const SampledWavelengths some_wavelengths = SampledWavelengths::sample_visible(0.37f);
const ReferencePoint eye{{0, 0, 0}, {0, 0, 1}, 1e-6f};

// Light 0 is the sun, light 1 the sky.
Scene sky_scene(double elevation, const Transform& t) {
    SkySettings settings;
    settings.elevation = elevation;
    settings.azimuth = 25;
    Scene scene;
    scene.skies.emplace_back(settings);
    const SkyModel& sky = scene.skies[0];
    scene.environments.push_back(sky_density_map(sky, 32));
    SunLight sun{add_spectrum(scene, Spectrum(sky.sun_radiance())), 3,
                 SunDisc::of_radius(normalize(t.vector(sky.sun_direction())), sun_angular_radius),
                 normalize(t.vector(Vec3f(0, 0, 1)))};
    scene.lights.push_back(sun);
    scene.lights.push_back(SkyLight{.sky = 0, .environment = 0, .scale = 3, .world_from_light = t});
    return scene;
}
const Transform tilted = Transform::rotate(77, {1, -2, 0.5});

void expect_directions_by_their_density(Scene scene) {
    // A sun that is large enough to be seen by the test, a small part of it below the horizon.
    SunDisc& sun = std::get<SunLight>(scene.lights[0]).disc;
    sun = SunDisc::of_radius(sun.centre, 0.6);
    EXPECT_NEAR(double(sun.pdf()) * sun.solid_angle(), 1, 1e-6);
    SceneTables tables(scene);
    for (Index light : {0u, 1u}) {
        int none = 0;
        auto sample = [&](Vec2f u) -> std::optional<Vec3f> {
            auto s = sample_li({tables.view(), light}, 0, eye, u, some_wavelengths);
            none += !s;
            if (!s) return std::nullopt;
            return s->wi;
        };
        auto pdf = [&](Vec3f w) -> float {
            if (light == 0 && dot(w, std::get<SunLight>(scene.lights[0]).up) < 0) return 0;
            return pdf_li({tables.view(), light}, {.p = eye.p}, {.wi = w});
        };
        ChiSquaredOptions options;
        options.samples = 100000;
        options.cells_x = options.cells_y = light == 0 ? 48 : 16;
        TestResult r = spherical_chi_squared_test(sample, pdf, options);
        EXPECT_TRUE(r.passes(1e-8)) << light << ": " << r.description;
        EXPECT_LT(none, 0.05 * options.samples) << light;
    }
}

TEST(SkyLights, DirectionsFollowTheirDensity) { expect_directions_by_their_density(sky_scene(30, tilted)); }

TEST(SkyLights, DirectionsFollowTheirDensityWhereTheSpaceIsStretched) {
    expect_directions_by_their_density(sky_scene(75, tilted * Transform::scale({1, -2, 0.6})));
}

TEST(SkyLights, SamplesAreWhatRaysFind) {
    // High, and half set.
    for (double elevation : {30.0, 0.05}) {
        const Scene scene = sky_scene(elevation, tilted);
        SceneTables tables(scene);
        EXPECT_EQ(tables.view().light_tables.infinite_lights.size(), 2u);
        TestUniforms uniforms(9);
        for (Index light : {0u, 1u}) {
            int differing = 0, hidden = 0;
            constexpr int samples = 5000;
            for (int i = 0; i < samples; ++i) {
                const Vec2f u = uniforms.next_2f();
                const auto s = sample_li({tables.view(), light}, 0, eye, u, some_wavelengths);
                if (!s) {
                    ++hidden;
                    continue;
                }
                ASSERT_FALSE(s->delta);
                ASSERT_TRUE(std::isinf(s->shadow.t_max));
                ASSERT_NEAR(length(s->wi), 1, 1e-5);
                ASSERT_GT(s->radiance[1], 0);
                // Rounding may send a direction across an edge.
                const bool same =
                    std::abs(pdf_li({tables.view(), light}, {.p = eye.p}, {.wi = s->wi}) / s->pdf - 1) <
                        1e-3f &&
                    std::abs(incident_radiance({tables.view(), light}, {.p = eye.p}, {.wi = s->wi},
                                               some_wavelengths)[1] /
                                 s->radiance[1] -
                             1) < 1e-3f;
                differing += !same;
            }
            EXPECT_LE(differing, 15) << light << " " << elevation;
            // The part of the disc below the horizon: 0.05 of 0.2666 degrees above the middle.
            const double part = light == 0 && elevation < 1 ? 1 - part_above_horizon(0.05, 0.2666) : 0;
            EXPECT_NEAR(hidden, part * samples, 5.5 * std::sqrt(part * samples)) << light;
        }
    }
}

// What arrives on horizontal ground, by samples of the lights and by directions alone.
TEST(SkyLights, GiveTheGroundTheIrradianceOfTheModel) {
    const Transform t = Transform::rotate(40, {1, 1, 0});
    const Vec3f up = t.vector(Vec3f(0, 0, 1));
    // High, and a little more and less than half of the disc risen.
    for (double elevation : {25.0, 0.1, -0.1}) {
        const Scene scene = sky_scene(elevation, t);
        SceneTables tables(scene);
        const float lambda = some_wavelengths.lambda[0];
        const double expected[] = {double(scene.skies[0].sun_irradiance()(lambda)),
                                   double(scene.skies[0].sky_irradiance()(lambda))};
        TestUniforms uniforms(3);
        for (Index light : {0u, 1u}) {
            RunningMoments m;
            for (int i = 0; i < 40000; ++i) {
                const Vec2f u = uniforms.next_2f();
                const auto s = sample_li({tables.view(), light}, 0, eye, u, some_wavelengths);
                m.add(s ? double(s->radiance[0] / s->pdf) * std::max(0.0, double(dot(s->wi, up))) / 3 : 0.0);
            }
            // The nearest nanometre against the wavelength.
            EXPECT_NEAR(m.mean() / expected[light], 1, 5.5 * m.standard_error() / expected[light] + 2e-3)
                << light << " " << elevation;
        }
    }
}

// The share of each light in the choice is that of its power.
TEST(SkyLights, AreChosenByTheirPower) {
    const Scene scene = sky_scene(40, Transform());
    SceneTables tables(scene);
    const SkyModel& sky = scene.skies[0];
    auto mean = [](const SpectrumTable& t) {
        double sum = 0;
        for (float v : t.values()) sum += double(v) / visible_samples;
        return sum;
    };
    TestUniforms uniforms(1);
    double dome = 0;
    constexpr int directions = 20000;
    for (int i = 0; i < directions; ++i) {
        const double z = 2 * uniforms.next() - 1, phi = 2 * pi * uniforms.next(), s = std::sqrt(1 - z * z);
        dome +=
            sky.mean_radiance(Vec3f(Vec3d{s * std::cos(phi), s * std::sin(phi), z})) * 4 * pi / directions;
    }
    const double disc =
        mean(sky.sun_radiance()) * SunDisc::of_radius({0, 0, 1}, sun_angular_radius).solid_angle();
    EXPECT_NEAR(double(tables.view().light_sampler->probability({}, 0, 0)), disc / (disc + dome), 0.01);
}

// A picture of the sky holds the light of dome and disc, wherever the disc meets the texels' edges. The ground hides
// the part of the disc that has set.
TEST(SkyMap, HoldsTheLightOfSkyAndSun) {
    for (double elevation : {0.0, 33.0}) {
        SkySettings settings;
        settings.elevation = elevation;
        settings.azimuth = elevation == 33.0 ? 0 : 180;
        const SkyModel sky(settings);
        const EnvironmentGrid grid(EnvironmentLayout::equirectangular, 256, 128);
        double sums[2] = {};
        const Image pictures[] = {sky_picture(sky, 128, false), sky_picture(sky, 128, true)};
        for (int y = 64; y < 128; ++y)
            for (int x = 0; x < 256; ++x)
                for (int c = 0; c < 3; ++c)
                    ASSERT_EQ(pictures[1].value(x, y, c), pictures[0].value(x, y, c))
                        << x << ' ' << elevation;
        for (bool with_sun : {false, true}) {
            const Image& picture = pictures[with_sun];
            for (int y = 0; y < 64; ++y)
                for (int x = 0; x < 256; ++x) {
                    const Vec3f rgb{picture.value(x, y, 0), picture.value(x, y, 1), picture.value(x, y, 2)};
                    ASSERT_GE(std::min(rgb.x, std::min(rgb.y, rgb.z)), 0);
                    const double z = double(
                        grid.direction({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}).z);
                    sums[with_sun] +=
                        dot(RgbColorSpace::srgb().luminance_weights(), Vec3d(rgb)) * z * grid.solid_angle(y);
                }
        }
        auto lux = [](const SpectrumTable& t) {
            return luminous_efficacy * integrate_luminance([&](float lambda) { return t(lambda); });
        };
        EXPECT_NEAR(sums[0] / lux(sky.sky_irradiance()), 1, 5e-3) << elevation;
        // Texels are wider than the disc, so that its height is uncertain by half of one: 0.7 degrees.
        if (elevation > 1) {
            EXPECT_NEAR((sums[1] - sums[0]) / lux(sky.sun_irradiance()), 1, 0.03) << elevation;
        }
        EXPECT_GT(sums[1], sums[0]) << elevation;
    }
}

} // namespace
} // namespace montelux
