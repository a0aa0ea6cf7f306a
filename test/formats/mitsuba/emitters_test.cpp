// Emitters of Mitsuba scenes as lights.
#include "test/formats/mitsuba/whole_scene.h"
#include <array>
#include <bit>
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/formats/mitsuba/sun_position.h"
#include "montelux/mc/math/constants.h"
#include "montelux/scene/build/emission.h"
#include "montelux/scene/light/environment/environment_grid.h"
#include "montelux/scene/light/light_context.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/spectrum/rgb_colorspace.h"

namespace montelux::mitsuba_emitters {
namespace {

using test::FileContents;
using test::load_scene_text;
using test::scene_text_error;
using test::WholeScene;

std::string emitter(const std::string& type, const std::string& content = "") {
    return "<emitter type=\"" + type + "\">" + content + "</emitter>";
}
std::string placed(const std::string& steps) {
    return "<transform name=\"to_world\">" + steps + "</transform>";
}
template <typename L>
const L& light(const WholeScene& s, std::size_t i = 0) {
    return std::get<L>(s.scene().lights.at(i));
}
// Times the white D65 of luminance 1, at one wavelength.
double brightness(const WholeScene& s, SceneSpectrum spectrum, float scale) {
    const Spectrum white(RgbColorSpace::srgb().illuminant());
    constexpr float lambda = 550;
    return double(spectrum_of(spectrum, s.scene().spectra)(lambda) * scale) /
           double(white(lambda) * photometric_scale(white));
}
void expect_near(Vec3f a, Vec3f b, float tolerance = 1e-5f) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}

// A PFM file of grey pixels, rows from top to bottom.
FileContents picture(int width, const std::vector<float>& values) {
    const int height = static_cast<int>(values.size()) / width;
    std::vector<std::uint8_t> bytes =
        test::bytes_of("PF\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n");
    for (int y = height - 1; y >= 0; --y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) {
                const auto v = std::bit_cast<std::array<std::uint8_t, 4>>(
                    values[static_cast<std::size_t>(y * width + x)]);
                bytes.insert(bytes.end(), v.begin(), v.end());
            }
    return {{"p.pfm", bytes}};
}

TEST(MitsubaEmitters, Area) {
    const WholeScene s = load_scene_text(R"(<shape type="sphere">
        <emitter type="area"><rgb name="radiance" value="2"/></emitter></shape>
        <shape type="disk"><emitter type="area"/></shape>)");
    const auto& ball = light<AreaLight>(s);
    EXPECT_NEAR(brightness(s, ball.spectrum, ball.scale), 2, 1e-3);
    EXPECT_FALSE(ball.two_sided);
    EXPECT_EQ(ball.shape, 0u);
    const auto& disk = light<AreaLight>(s, 1);
    EXPECT_NEAR(brightness(s, disk.spectrum, disk.scale), 1, 1e-3);
    const auto on_shape = [](const std::string& e) {
        return scene_text_error("<shape type=\"sphere\">" + e + "</shape>");
    };
    EXPECT_NE(on_shape(emitter("point")).find("surfaces shine by the emitter 'area'"), std::string::npos);
    EXPECT_NE(on_shape(emitter("directionalarea")).find("not supported"), std::string::npos);
    EXPECT_NE(on_shape(emitter("aera")).find("did you mean 'area'"), std::string::npos);
    // In the scene it is there for references.
    const WholeScene shared =
        load_scene_text(R"(<emitter type="area" id="glow"><rgb name="radiance" value="2"/>
        </emitter><shape type="sphere"><ref id="glow"/></shape><shape type="disk"><ref id="glow"/></shape>)");
    EXPECT_EQ(shared.scene().lights.size(), 2u);
    EXPECT_TRUE(shared.warnings.empty());
    EXPECT_TRUE(load_scene_text(emitter("area")).warns("no shape refers to"));
}

TEST(MitsubaEmitters, Point) {
    const WholeScene s = load_scene_text(
        emitter("point", R"(<point name="position" value="1, 2, 3"/><rgb name="intensity" value="5"/>)") +
        emitter("point", placed("<translate value=\"4, 5, 6\"/>")));
    const auto& first = light<PointLight>(s);
    expect_near(first.position, {1, 2, 3});
    EXPECT_NEAR(brightness(s, first.spectrum, first.scale), 5, 1e-2);
    expect_near(light<PointLight>(s, 1).position, {4, 5, 6});
    EXPECT_NE(scene_text_error(emitter("point", R"(<point name="position" value="1, 2, 3"/>)" +
                                                    placed("<scale value=\"2\"/>"))),
              "");
}

TEST(MitsubaEmitters, Spot) {
    const WholeScene s = load_scene_text(
        emitter("spot", placed(R"(<lookat origin="1, 2, 3" target="1, 2, 5" up="0, 1, 0"/>)") +
                            R"(<float name="cutoff_angle" value="40"/>)"));
    const auto& spot = light<SpotLight>(s);
    expect_near(spot.position, {1, 2, 3});
    expect_near(spot.axis, {0, 0, 1});
    // Linear from three quarters of the angle on.
    const auto at = [&](double degrees) {
        const double a = degrees * pi / 180;
        return spot.falloff(Vec3f(Vec3d(std::sin(a), 0, std::cos(a))));
    };
    EXPECT_EQ(at(29.9), 1);
    EXPECT_NEAR(at(32.5), 0.75, 1e-4);
    EXPECT_NEAR(at(37), 0.3, 1e-4);
    EXPECT_EQ(at(40.1), 0);
    EXPECT_NE(scene_text_error(emitter("spot", R"(<float name="beam_width" value="30"/>)")).find("wider"),
              std::string::npos);
    EXPECT_NE(scene_text_error(emitter("spot", R"(<texture type="checkerboard" name="texture"/>)")), "");
}

// The picture fills the square around the cone: columns along x, rows along y.
TEST(MitsubaEmitters, SpotWithAPicture) {
    const WholeScene s = load_scene_text(
        emitter("spot", R"(<float name="cutoff_angle" value="45"/><float name="beam_width" value="45"/>
            <texture type="bitmap" name="texture"><string name="filename" value="p.pfm"/></texture>)"),
        picture(2, {0.1f, 0.2f, 0.3f, 0.4f}));
    const auto& spot = light<SpotLight>(s);
    const SceneTables tables(s.scene());
    const SceneView view = tables.view();
    const SampledWavelengths lambda = SampledWavelengths::sample_visible(0.4f);
    const SampledSpectrum plain = view.sample(spot.spectrum, lambda) * spot.scale;
    const auto share = [&](float x, float y) {
        return spot.intensity({view, 0}, normalize(Vec3f(x, y, 1)), lambda)[0] / plain[0];
    };
    // At the centres of the texels, and between them.
    EXPECT_NEAR(share(-0.5f, -0.5f), 0.1f, 1e-4f);
    EXPECT_NEAR(share(0.5f, -0.5f), 0.2f, 1e-4f);
    EXPECT_NEAR(share(-0.5f, 0.5f), 0.3f, 1e-4f);
    EXPECT_NEAR(share(0.5f, 0.5f), 0.4f, 1e-4f);
    EXPECT_NEAR(share(0, -0.5f), 0.15f, 1e-4f);
    EXPECT_EQ(share(0.8f, 0.8f), 0); // beyond the cone
}

TEST(MitsubaEmitters, Directional) {
    const WholeScene s = load_scene_text(
        emitter("directional", R"(<vector name="direction" value="0, -2, 0"/>)") +
        emitter("directional", placed(R"(<lookat origin="0, 0, 0" target="1, 0, 0" up="0, 1, 0"/>)")));
    expect_near(light<DistantLight>(s).to_light, {0, 1, 0});
    expect_near(light<DistantLight>(s, 1).to_light, {-1, 0, 0});
    EXPECT_NE(scene_text_error(emitter("directional", R"(<vector name="direction" value="0, 0, 0"/>)")), "");
}

TEST(MitsubaEmitters, Constant) {
    const WholeScene s = load_scene_text(emitter("constant", R"(<float name="radiance" value="0.5"/>)"));
    const auto& sky = light<UniformInfiniteLight>(s);
    EXPECT_NEAR(brightness(s, sky.spectrum, sky.scale), 0.5, 1e-3);
}

// The texel of the environment that is seen along a direction.
float seen_along(const WholeScene& s, Vec3f w) {
    const auto& map = light<ImageInfiniteLight>(s);
    const Image& image = s.scene().environments.at(map.environment);
    const EnvironmentGrid grid(map.layout, image.width(), image.height());
    const Vec2f at = grid.locate(normalize(Vec3f(map.world_from_light.inverse_vector(Vec3d(w)))));
    return image.value(static_cast<int>(at.x), static_cast<int>(at.y), 0);
}

TEST(MitsubaEmitters, EnvironmentMap) {
    // Columns from -z over +x and +z to -x; the pole of the first row is +y.
    const std::string content = R"(<string name="filename" value="p.pfm"/><float name="scale" value="3"/>)";
    const FileContents files = picture(4, {9, 9, 9, 9, 1, 2, 3, 4, 7, 7, 7, 7});
    const WholeScene s = load_scene_text(emitter("envmap", content), files);
    const auto level = [](float phi) { return Vec3f(std::sin(phi), 0, -std::cos(phi)); };
    for (int column = 0; column < 4; ++column) {
        const float phi = (static_cast<float>(column) + 0.5f) * pi_f / 2;
        EXPECT_NEAR(seen_along(s, level(phi)), static_cast<float>(column + 1), 0.1f) << column;
    }
    EXPECT_NEAR(seen_along(s, {0.01f, 1, 0}), 9, 0.1f);
    EXPECT_NEAR(seen_along(s, {0.01f, -1, 0}), 7, 0.1f);
    // Between the rows, at their middle.
    EXPECT_NEAR(seen_along(s, {0.5f, 1 / std::sqrt(2.0f), -0.5f}), (9 + 1) / 2.0f, 0.1f);
    EXPECT_NEAR(light<ImageInfiniteLight>(s).scale /
                    (3 * photometric_scale(Spectrum(RgbColorSpace::srgb().illuminant()))),
                1, 1e-6);
    EXPECT_EQ(s.description.integrator.environment_lookup, EnvironmentLookup::bilinear);
    const WholeScene turned =
        load_scene_text(emitter("envmap", content + placed(R"(<rotate x="1" angle="90"/>)")), files);
    EXPECT_NEAR(seen_along(turned, {0.01f, 0, 1}), 9, 0.1f);
    EXPECT_NE(scene_text_error(emitter("envmap")).find("needs the property 'filename'"), std::string::npos);
}

TEST(MitsubaEmitters, Projector) {
    // The picture's left is towards +x, and its top towards +y: as a camera there sees it.
    const WholeScene s =
        load_scene_text(emitter("projector", R"(<float name="fov" value="90"/><float name="scale" value="2"/>
            <texture type="bitmap" name="irradiance"><string name="filename" value="p.pfm"/></texture>)"),
                        picture(2, {1, 2, 3, 4}));
    const auto& projector = light<ProjectionLight>(s);
    EXPECT_EQ(projector.profile, ProjectionProfile::irradiance);
    EXPECT_NEAR(projector.fov, 90, 1e-4);
    EXPECT_NEAR(projector.scale / (2 * pi_f * photometric_scale(Spectrum(1.0f))), 1, 1e-3);
    const auto texel = [&](Vec3f w) {
        const Image& image = s.scene().environments.at(projector.environment);
        const ProjectionScreen screen(image.width(), image.height(), projector.fov);
        const auto at = screen.locate(Vec3f(projector.world_from_light.inverse_vector(Vec3d(w))));
        return at ? image.value(static_cast<int>(at->x), static_cast<int>(at->y), 0) : 0;
    };
    EXPECT_EQ(texel({0.5f, 0.5f, 1}), 1);
    EXPECT_EQ(texel({-0.5f, 0.5f, 1}), 2);
    EXPECT_EQ(texel({0.5f, -0.5f, 1}), 3);
    EXPECT_EQ(texel({-0.5f, -0.5f, 1}), 4);
    EXPECT_EQ(texel({0.5f, 0.5f, -1}), 0);
    const WholeScene plain =
        load_scene_text(emitter("projector", R"(<rgb name="irradiance" value="1, 2, 3"/>)"));
    EXPECT_EQ(plain.scene().environments.at(0).value(0, 0, 2), 3);
}

TEST(MitsubaEmitters, PicturesGoOnBeyondTheirBordersAsTheirTexturesSay) {
    const std::vector<float> columns{1, 2, 4, 8};
    struct Case {
        const char* settings;
        PictureLookup lookup;
        float at_the_left_edge;
    };
    for (const auto& [settings, lookup, at_the_left_edge] :
         {Case{"", PictureLookup::repeating, 4.5f},
          Case{R"(<string name="wrap_mode" value="mirror"/>)", PictureLookup::bilinear, 1},
          Case{R"(<string name="wrap_mode" value="clamp"/>)", PictureLookup::bilinear, 1},
          Case{R"(<string name="filter_type" value="nearest"/>)", PictureLookup::nearest, 1}}) {
        const auto bitmap = [&](const std::string& name) {
            return "<texture type=\"bitmap\" name=\"" + name +
                   "\"><string name=\"filename\" value=\"p.pfm\"/>" + settings + "</texture>";
        };
        const WholeScene projected =
            load_scene_text(emitter("projector", bitmap("irradiance")), picture(4, columns));
        EXPECT_EQ(light<ProjectionLight>(projected).picture_lookup, lookup) << settings;
        EXPECT_EQ(light<SpotLight>(load_scene_text(emitter("spot", bitmap("texture")), picture(4, columns)))
                      .picture_lookup,
                  lookup)
            << settings;
        const WholeScene s =
            load_scene_text("<shape type=\"rectangle\">" + emitter("area", bitmap("radiance")) + "</shape>",
                            picture(4, columns));
        const auto& area = light<AreaLight>(s);
        EXPECT_EQ(area.picture_lookup, lookup) << settings;
        const SceneTables tables(s.scene());
        const LightTablesView& lights = LightContext{tables.view(), 0}.tables();
        const SampledWavelengths lambda = SampledWavelengths::sample_visible(0.4f);
        const auto color = [&](float u) {
            return lights.picture_color(area.picture, {u, 0.5f}, lookup, lambda)[0];
        };
        EXPECT_NEAR(color(0), at_the_left_edge, 1e-3f) << settings;
        EXPECT_NEAR(color(0.375f), 2, 1e-3f) << settings;
        EXPECT_NEAR(color(0.49f), lookup == PictureLookup::nearest ? 2 : 2.92f, 1e-3f) << settings;
    }
}

TEST(MitsubaEmitters, PicturesOnSurfaces) {
    const WholeScene s = load_scene_text(R"(<shape type="rectangle"><emitter type="area">
        <texture type="bitmap" name="radiance"><string name="filename" value="p.pfm"/></texture>
        </emitter></shape>)",
                                         picture(1, {5, 1}));
    const auto& area = light<AreaLight>(s);
    // The top row, which is at v = 0 there, is at v = 1 in ours.
    EXPECT_EQ(s.scene().environments.at(area.picture).value(0, 1, 0), 5);
    // A bitmap has absolute spectra; in a "d65" its white is the illuminant.
    EXPECT_TRUE(area.equal_energy);
    EXPECT_FLOAT_EQ(area.scale, photometric_scale(Spectrum(1.0f)));
    const WholeScene white = load_scene_text(R"(<shape type="rectangle"><emitter type="area">
        <texture type="d65" name="radiance"><float name="scale" value="2"/>
        <texture type="bitmap"><string name="filename" value="p.pfm"/></texture></texture>
        </emitter></shape>)",
                                             picture(1, {5, 1}));
    EXPECT_FALSE(light<AreaLight>(white).equal_energy);
    EXPECT_FLOAT_EQ(light<AreaLight>(white).scale,
                    2 * photometric_scale(Spectrum(RgbColorSpace::srgb().illuminant())));
}

TEST(MitsubaEmitters, Sky) {
    const WholeScene s = load_scene_text(emitter("sunsky", R"(<vector name="sun_direction" value="0, 1, 1"/>
        <float name="turbidity" value="4"/><float name="sun_scale" value="0.5"/>)"));
    ASSERT_EQ(s.scene().lights.size(), 2u);
    const auto& sun = light<SunLight>(s);
    expect_near(sun.disc.centre, normalize(Vec3f(0, 1, 1)));
    const auto& sky = light<SkyLight>(s, 1);
    EXPECT_FLOAT_EQ(sun.scale, sky.scale / 2);
    EXPECT_EQ(s.scene().skies.at(0).settings().atmosphere.turbidity, 4);
    // Absolute: a radiance of 1 W/(m^2 sr nm) at all wavelengths has a luminance of 1.
    EXPECT_NEAR(to_photometric(Spectrum(1.0f)) * double(sky.scale), 1, 1e-3);
    const WholeScene no_sun = load_scene_text(emitter("sunsky", R"(<float name="sun_scale" value="0"/>)"));
    EXPECT_EQ(no_sun.scene().lights.size(), 1u);
    EXPECT_NE(scene_text_error(emitter("sunsky", R"(<vector name="sun_direction" value="0, 1, 1"/>
        <float name="hour" value="4"/>)")),
              "");
}

TEST(MitsubaEmitters, SunByPlaceAndTime) {
    // Noon of the equinox at the equator, with the sun in the zenith but for the equation of time (7.5 minutes).
    const Vec3d equinox = mitsuba::sun_position(
        {.latitude = 0, .longitude = 0, .timezone = 0, .year = 2010, .month = 3, .day = 20, .hour = 12});
    EXPECT_GT(equinox.z, 0.999);
    // Midsummer at noon in the middle of Europe, 23.4 degrees beyond the tropic: in the south.
    const Vec3d summer = mitsuba::sun_position(
        {.latitude = 50, .longitude = 15, .timezone = 1, .year = 2010, .month = 6, .day = 21, .hour = 12});
    EXPECT_NEAR(std::asin(summer.z) * 180 / pi, 90 - 50 + 23.44, 0.1);
    EXPECT_GT(summer.x, 0.44);
    // Mornings are in the east.
    const Vec3d morning = mitsuba::sun_position(
        {.latitude = 50, .longitude = 15, .timezone = 1, .year = 2010, .month = 6, .day = 21, .hour = 8});
    // The numbers of Mitsuba 3.9.1.
    expect_near(Vec3f(morning), {0.0912268f, -0.797983f, 0.595735f}, 2e-4f);
    expect_near(Vec3f(summer), {0.447173f, -0.00704427f, 0.89442f}, 2e-4f);
    expect_near(Vec3f(mitsuba::sun_position({})), {0.0513854f, 0.691748f, 0.720308f}, 2e-4f);
    EXPECT_NEAR(length(morning), 1, 1e-9);
    // Minutes and seconds are parts of the hour.
    expect_near(Vec3f(mitsuba::sun_position({.hour = 15, .minute = 30, .second = 45})),
                Vec3f(mitsuba::sun_position({.hour = 15 + 1845.0 / 3600})), 1e-6f);
}

TEST(MitsubaEmitters, OthersAreRefused) {
    EXPECT_NE(scene_text_error(emitter("timed_sunsky")).find("not supported"), std::string::npos);
    EXPECT_NE(scene_text_error(emitter("pointlight")).find("there is no emitter 'pointlight'"),
              std::string::npos);
}

} // namespace
} // namespace montelux::mitsuba_emitters
