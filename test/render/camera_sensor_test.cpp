// Film values by the sensor of a camera.
#include "test/render/scene_testing.h"
#include <gtest/gtest.h>

#include "montelux/spectrum/illuminants.h"
#include "montelux/spectrum/sensor.h"

namespace montelux::testing {
namespace {

// Light seen directly, of the colour for which the sensor is balanced: its film value is that of the sensor.
TEST(CameraSensors, FilmValuesOfAUniformLight) {
    for (const char* name : {"cie1931", "canon_eos_5d", "nikon_d850"}) {
        SceneBuilder b;
        const SpectrumTable light = daylight(5000);
        std::vector<float> pairs;
        for (int l = 360; l <= 830; ++l) {
            pairs.push_back(static_cast<float>(l));
            pairs.push_back(light(static_cast<float>(l)));
        }
        const Spectrum spectrum(PiecewiseLinear::from_pairs(pairs));
        const auto scale = static_cast<float>(2 / to_photometric(spectrum));
        b.scene.lights.push_back(UniformInfiniteLight{add_spectrum(b.scene, spectrum), scale});
        b.look({0, 0, 0}, {0, 0, 1}, 40);
        FilmSettings& film = b.description.film;
        film.sensor = name;
        film.white_balance = 5000;
        film.iso = 400;
        film.exposure_time = 0.5f;
        b.description.sampler.spp = 256;
        const Vec3d truth = Sensor(RgbColorSpace::srgb(),
                                   {.exposure_time = 0.5f, .iso = 400, .white_balance = 5000, .name = name})
                                .integrate_rgb([&](float l) { return light(l) * scale; });
        const Film picture = render(b.description);
        for (int c = 0; c < 3; ++c) {
            const PictureMean m = picture_mean(picture, c);
            EXPECT_NEAR(m.mean, truth[c], 5.5 * m.standard_error + 1e-4) << name << c;
            EXPECT_NEAR(truth[c], 4, 0.15) << name << c; // grey
        }
    }
}

// The layer of albedo tells of surfaces, not of the camera.
TEST(CameraSensors, LeaveTheAlbedoAsItIs) {
    SceneBuilder b;
    b.add_uniform_light(1);
    b.add_mesh(square(Transform::scale({9, 9, 1})),
               b.add(DiffuseMaterial{SpectrumParameter{
                   add_spectrum(b.scene, RgbAlbedoSpectrum(RgbColorSpace::srgb(), {0.7f, 0.3f, 0.1f}))}}));
    b.look({0, 0, 1}, {0, 0, 0}, 40);
    const Film plain = render(b.description);
    FilmSettings& film = b.description.film;
    film.sensor = "canon_eos_5d";
    film.white_balance = 4000;
    film.iso = 400;
    const Film other = render(b.description);
    for (std::size_t i = 0; i < plain.pixels().size(); ++i) {
        const Vec3f albedo = plain.pixels()[i].albedo();
        EXPECT_EQ(albedo, other.pixels()[i].albedo());
        EXPECT_GT(albedo.x, 2 * albedo.z);
    }
}

} // namespace
} // namespace montelux::testing
