// The light "sky" of scene files: position of the sun, brightness, and error messages.
#include "test/formats/pbrt/parse.h"
#include <gtest/gtest.h>
#include <string>

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

using test::parse_world;

double photometric(const SpectrumTable& t) {
    return luminous_efficacy * integrate_luminance([&](float lambda) { return t(lambda); });
}

TEST(PbrtSky, SunAndSkyOfTheModel) {
    const SceneDescription d = parse_world("Rotate -90 1 0 0 LightSource \"sky\" \"float elevation\" 30 "
                                           "\"float azimuth\" 90 \"float turbidity\" 3 "
                                           "\"float groundalbedo\" 0.4 \"float scale\" 2");
    ASSERT_EQ(d.scene.lights.size(), 2u);
    const auto& sun = std::get<SunLight>(d.scene.lights[0]);
    const auto& sky = std::get<SkyLight>(d.scene.lights[1]);
    // z of the light's space is y of the world, y is -z.
    EXPECT_LT(length(sun.disc.centre - Vec3f(0, 0.5f, -std::sqrt(0.75f))), 1e-5f);
    EXPECT_LT(length(sun.up - Vec3f(0, 1, 0)), 1e-6f);
    EXPECT_FLOAT_EQ(sky.scale, 2 * 683);
    EXPECT_EQ(sun.scale, sky.scale);
    ASSERT_EQ(d.scene.skies.size(), 1u);
    const SkySettings& s = d.scene.skies[sky.sky].settings();
    EXPECT_EQ(s.atmosphere.turbidity, 3);
    EXPECT_EQ(s.ground_albedo(500), 0.4f);
    EXPECT_EQ(d.scene.environments[sky.environment].width(), 512);
    EXPECT_EQ(spectrum_of(sun.spectrum, d.scene.spectra)(500), d.scene.skies[sky.sky].sun_radiance()(500));
}

TEST(PbrtSky, VectorToTheSun) {
    const SceneDescription d =
        parse_world("LightSource \"sky\" \"vector3 sun\" [ -2 0 2 ] \"rgb groundalbedo\" [ .1 .2 .3 ]");
    EXPECT_NEAR(d.scene.skies[0].settings().elevation, 45, 1e-5);
    EXPECT_NEAR(d.scene.skies[0].settings().azimuth, 180, 1e-5);
    EXPECT_NEAR(double(d.scene.skies[0].settings().ground_albedo(620)), 0.1, 0.05);
}

TEST(PbrtSky, IlluminanceOfSkyAndSun) {
    SceneDescription d = parse_world("LightSource \"sky\" \"float illuminance\" 1000");
    const SkyModel model = d.scene.skies[0]; // d is read again
    const double whole = photometric(model.sky_irradiance()) + photometric(model.sun_irradiance());
    EXPECT_NEAR(double(std::get<SkyLight>(d.scene.lights[1]).scale) / 683 * whole, 1000, 0.1);
    d = parse_world("LightSource \"sky\" \"float illuminance\" 1000 \"bool sundisc\" false");
    ASSERT_EQ(d.scene.lights.size(), 1u);
    EXPECT_NEAR(double(std::get<SkyLight>(d.scene.lights[0]).scale) / 683 *
                    photometric(model.sky_irradiance()),
                1000, 0.1);
    // Dusk has no sun to be seen.
    EXPECT_EQ(parse_world("LightSource \"sky\" \"float elevation\" -3").scene.lights.size(), 1u);
}

TEST(PbrtSky, MistakesGetASentence) {
    const std::pair<const char*, const char*> cases[] = {
        {"\"float elevation\" 91", "parameter 'elevation' is above 90 degrees"},
        {"\"float elevation\" -8", "more than 6 degrees below the horizon"},
        {"\"vector3 sun\" [ 1 0 -1 ]", "more than 6 degrees below the horizon"},
        {"\"vector3 sun\" [ 0 0 0 ]", "parameter 'sun' is not a direction"},
        {"\"vector3 sun\" [ 0 0 1 ] \"float elevation\" 3", "'elevation' together with 'sun'"},
        {"\"vector3 sun\" [ 0 0 1 ] \"float azimuth\" 3", "'azimuth' together with 'sun'"},
        {"\"float turbidity\" 0.9", "parameter 'turbidity' is not in [1, 10]"},
        {"\"float turbidity\" 11", "parameter 'turbidity' is not in [1, 10]"},
        {"\"float groundalbedo\" 1.5", "parameter 'groundalbedo' is not between 0 and 1"},
        {"\"float scale\" -1", "parameter 'scale' is negative"},
    };
    for (auto [parameters, sentence] : cases) try {
            parse_world(std::string("LightSource \"sky\" ") + parameters);
            ADD_FAILURE() << parameters << " was accepted";
        } catch (const Error& e) {
            EXPECT_NE(std::string(e.what()).find(sentence), std::string::npos) << e.what();
        }
    Warnings warnings;
    parse_world("LightSource \"sky\" \"float elevation\" -6 \"float turbidty\" 2", &warnings);
    ASSERT_EQ(warnings.messages().size(), 1u);
}

} // namespace
} // namespace montelux
