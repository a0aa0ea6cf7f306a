// Digests of lights: every value of every kind counts, and their maps and skies.
#include "test/scene/scene_digest_testing.h"
#include <gtest/gtest.h>

#include "montelux/scene/scene_digest.h"

namespace montelux {
namespace {

using testing::change_spectrum_of_light;
using testing::expect_changes;

TEST(SceneDigest, LightsCount) {
    const RgbColorSpace& srgb = RgbColorSpace::srgb();
    const Spectrum red(RgbIlluminantSpectrum(srgb, {1, 0, 0}));
    SkySettings dusk;
    dusk.elevation = 3;
    SkySettings snow;
    snow.ground_albedo = Spectrum(0.9f);
    const Transform moved = Transform::translate({1, 0, 0});
    SkySettings haze;
    haze.atmosphere.turbidity = 5;
    expect_changes(
        &SceneDigest::lights,
        {change_spectrum_of_light<AreaLight>(red),
         change_spectrum_of_light<PointLight>(red),
         change_spectrum_of_light<SpotLight>(red),
         change_spectrum_of_light<DistantLight>(red),
         change_spectrum_of_light<UniformInfiniteLight>(red),
         change_spectrum_of_light<SunLight>(red),
         [](Scene& s) { std::get<AreaLight>(s.lights[0]).two_sided = true; },
         [](Scene& s) { std::get<AreaLight>(s.lights[0]).primitive_flux = 1; },
         [](Scene& s) { std::get<AreaLight>(s.lights[0]).picture = 0; },
         [](Scene& s) { std::get<AreaLight>(s.lights[0]).equal_energy = true; },
         [](Scene& s) { std::get<ProjectionLight>(s.lights[9]).equal_energy = true; },
         [](Scene& s) { std::get<PointLight>(s.lights[1]).position.x = 1; },
         [](Scene& s) { std::get<SpotLight>(s.lights[2]).scale = 2; },
         [](Scene& s) { std::get<SpotLight>(s.lights[2]).position.x = 1; },
         [](Scene& s) {
             std::get<SpotLight>(s.lights[2]).axis = {1, 0, 0};
         },
         [](Scene& s) { std::get<SpotLight>(s.lights[2]).cos_falloff_start = 0.75f; },
         [](Scene& s) { std::get<SpotLight>(s.lights[2]).cos_total_width = 0.5f; },
         [](Scene& s) { std::get<SpotLight>(s.lights[2]).picture = 0; },
         [](Scene& s) {
             std::get<SpotLight>(s.lights[2]).picture = 0;
             std::get<SpotLight>(s.lights[2]).picture_x = {1, 0, 0};
         },
         [](Scene& s) {
             std::get<SpotLight>(s.lights[2]).picture = 0;
             std::get<SpotLight>(s.lights[2]).picture_y = {1, 0, 0};
         },
         [](Scene& s) { std::get<SpotLight>(s.lights[2]).profile = SpotFalloff::linear; },
         [](Scene& s) {
             std::get<DistantLight>(s.lights[3]).to_light = {1, 0, 0};
         },
         [](Scene& s) { std::get<UniformInfiniteLight>(s.lights[4]).portal.reset(); },
         [](Scene& s) { std::get<ImageInfiniteLight>(s.lights[5]).scale = 2; },
         [](Scene& s) {
             std::get<ImageInfiniteLight>(s.lights[5]).layout = EnvironmentLayout::equirectangular;
         },
         [](Scene& s) {
             std::get<SkyLight>(s.lights[6]).world_from_light = Transform::rotate(9, {0, 0, 1});
         },
         [](Scene& s) { std::get<SunLight>(s.lights[7]).disc.versine = 0.5f; },
         change_spectrum_of_light<GoniometricLight>(red),
         [](Scene& s) { std::get<GoniometricLight>(s.lights[8]).scale = 2; },
         [](Scene& s) { std::get<GoniometricLight>(s.lights[8]).environment = 1; },
         [](Scene& s) {
             std::get<GoniometricLight>(s.lights[8]).layout = EnvironmentLayout::equirectangular;
         },
         [=](Scene& s) { std::get<GoniometricLight>(s.lights[8]).world_from_map = moved; },
         [](Scene& s) { std::get<ProjectionLight>(s.lights[9]).environment = 1; },
         [](Scene& s) { std::get<ProjectionLight>(s.lights[9]).scale = 2; },
         [](Scene& s) { std::get<ProjectionLight>(s.lights[9]).fov = 20; },
         [](Scene& s) { std::get<ProjectionLight>(s.lights[9]).profile = ProjectionProfile::irradiance; },
         [=](Scene& s) { std::get<ProjectionLight>(s.lights[9]).world_from_light = moved; },
         [](Scene& s) { s.environments[0].f32()[100] = 1; },
         [=](Scene& s) { s.skies[0] = SkyModel(dusk); },
         [=](Scene& s) { s.skies[0] = SkyModel(snow); },
         [=](Scene& s) { s.skies[0] = SkyModel(haze); },
         [](Scene& s) { std::swap(s.lights[1], s.lights[2]); }});
}

} // namespace
} // namespace montelux
