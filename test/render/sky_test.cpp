// Pictures lit by sun and sky: light samples, BSDF samples and both together see the same. Differences at 5.5
// standard errors (4e-8).
#include "test/render/scene_testing.h"
#include <gtest/gtest.h>

#include "montelux/scene/light/sky/sky_map.h"

namespace montelux::testing {
namespace {

// A ball on level ground under a sky whose sun is wide enough to be found by chance.
SceneBuilder ball_in_the_sun() {
    SceneBuilder b;
    SkySettings settings;
    settings.elevation = 30;
    settings.azimuth = 140;
    b.scene.skies.emplace_back(settings);
    const SkyModel& sky = b.scene.skies[0];
    b.scene.environments.push_back(sky_density_map(sky, 64));
    b.scene.lights.push_back(SkyLight{.sky = 0, .environment = 0, .scale = 3, .world_from_light = {}});
    const double wider = 0.3;
    SunLight sun{add_spectrum(b.scene, Spectrum(sky.sun_radiance())),
                 3,
                 SunDisc::of_radius(sky.sun_direction(), wider),
                 {0, 0, 1}};
    sun.scale *= static_cast<float>(SunDisc::of_radius({0, 0, 1}, sun_angular_radius).solid_angle() /
                                    sun.disc.solid_angle());
    b.scene.lights.push_back(sun);
    b.add_quadric(Disk{.radius = 20, .world_from_object = {}}, b.add(DiffuseMaterial{gray(0.4f)}));
    b.add_quadric(Sphere{.world_from_object = Transform::translate({0, 0, 1})},
                  b.add(ConductorMaterial{.metal = {.eta = gray(1.2f), .k = gray(3)},
                                          .roughness = {FloatParameter{0.3f}, FloatParameter{0.3f}, false}}));
    b.look({0, -6, 2}, {0, 0, 0.8}, 40);
    return b;
}

TEST(SkyPictures, StrategiesAgree) {
    SceneBuilder b = ball_in_the_sun();
    b.description.integrator.max_depth = 3;
    b.description.sampler.spp = 256;
    b.description.integrator.strategy = Strategy::mis;
    const PictureMean mis = picture_mean(render(b.description));
    EXPECT_GT(mis.mean, 10);
    for (Strategy s : {Strategy::bsdf, Strategy::light}) {
        b.description.integrator.strategy = s;
        const PictureMean other = picture_mean(render(b.description));
        EXPECT_NEAR(other.mean, mis.mean, 5.5 * std::hypot(mis.standard_error, other.standard_error))
            << int(s);
        EXPECT_LT(other.standard_error, 0.1 * other.mean);
    }
}

// White level ground that reflects all: radiance is irradiance over pi.
TEST(SkyPictures, GroundHasTheIlluminanceOfTheModel) {
    SceneBuilder b;
    SkySettings settings;
    settings.elevation = 35;
    b.scene.skies.emplace_back(settings);
    const SkyModel& sky = b.scene.skies[0];
    b.scene.environments.push_back(sky_density_map(sky, 64));
    b.scene.lights.push_back(SkyLight{.sky = 0, .environment = 0, .scale = 683, .world_from_light = {}});
    b.scene.lights.push_back(SunLight{add_spectrum(b.scene, Spectrum(sky.sun_radiance())),
                                      683,
                                      SunDisc::of_radius(sky.sun_direction(), sun_angular_radius),
                                      {0, 0, 1}});
    b.add_quadric(Disk{.radius = 20, .world_from_object = {}}, b.add(DiffuseMaterial{gray(1)}));
    b.look({0, -1, 3}, {0, 0, 0}, 40);
    b.description.integrator.max_depth = 1;
    const Film film = render(b.description);
    double luminance = 0, error = 0;
    const Vec3d weights = RgbColorSpace::srgb().luminance_weights();
    for (int c = 0; c < 3; ++c) {
        const PictureMean m = picture_mean(film, c);
        luminance += weights[c] * m.mean;
        error += weights[c] * m.standard_error; // channels vary together
    }
    const SpectrumTable from_sky = sky.sky_irradiance(), from_sun = sky.sun_irradiance();
    const double expected = luminous_efficacy / pi * integrate_luminance([&](float lambda) {
                                return from_sky(lambda) + from_sun(lambda);
                            });
    EXPECT_NEAR(luminance, expected, 5.5 * error + 2e-3 * expected);
    EXPECT_LT(error, 0.02 * expected);
}

} // namespace
} // namespace montelux::testing
