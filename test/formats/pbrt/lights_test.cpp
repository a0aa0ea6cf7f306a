// Lights with pbrt-v4's defaults and units.
#include "test/formats/pbrt/parse.h"
#include "test/temporary_folder.h"
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <span>
#include <string>

#include "montelux/image/image_write.h"
#include "montelux/scene/build/emission.h"
#include "montelux/scene/light/light_sampling.h"
#include "montelux/scene/light/visible_mean.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/spectrum/rgb_colorspace.h"

namespace montelux {
namespace {

using test::parse_world;
using test::WithSpectra;

constexpr double pi = std::numbers::pi;

template <typename T>
WithSpectra<T> light(const std::string& directive) {
    SceneDescription d = parse_world(directive);
    return {std::get<T>(d.scene.lights.at(0)), d.scene.spectra};
}
template <typename T>
double photometric(const T& l, std::span<const Spectrum> spectra) {
    return l.scale * to_photometric(spectrum_of(l.spectrum, spectra));
}
template <typename T>
double photometric(const WithSpectra<T>& l) {
    return photometric<T>(l, l.spectra);
}

TEST(PbrtLights, UnitsOfEveryKind) {
    auto point = light<PointLight>("Translate 1 0 0 LightSource \"point\" \"point3 from\" [ 0 2 0 ]");
    EXPECT_EQ(point.position, Vec3f(1, 2, 0));
    EXPECT_NEAR(photometric(point), 1, 1e-5);
    EXPECT_NEAR(photometric(light<PointLight>("LightSource \"point\" \"float power\" 100 \"float scale\" 2")),
                2 * 100 / (4 * pi), 1e-4);
    // An RGB colour counts on top of its white.
    auto red = light<PointLight>("LightSource \"point\" \"rgb I\" [ 2 2 2 ]");
    double y = 0;
    for (float lambda = 360; lambda <= 830; lambda += 1)
        y += red.of(red.spectrum)(lambda) * cie_y[static_cast<std::size_t>(lambda - 360)];
    EXPECT_NEAR(red.scale * y, 2, 2e-3);
    EXPECT_NEAR(
        photometric(light<PointLight>("LightSource \"point\" \"blackbody I\" 3000 \"float scale\" 7")), 7,
        1e-4);
    EXPECT_EQ(photometric(light<PointLight>("LightSource \"point\" \"spectrum I\" [ 400 0 700 0 ]")), 0);

    auto spot =
        light<SpotLight>("LightSource \"spot\" \"point3 to\" [ 0 3 0 ] \"float coneangle\" 60 \"float "
                         "conedeltaangle\" 15 \"float power\" 10");
    EXPECT_FLOAT_EQ(spot.cos_total_width, 0.5f);
    EXPECT_FLOAT_EQ(spot.cos_falloff_start, std::sqrt(0.5f));
    EXPECT_EQ(spot.axis, Vec3f(0, 1, 0));
    EXPECT_NEAR(photometric(spot), 10 / (2 * pi * ((1 - std::sqrt(0.5)) + (std::sqrt(0.5) - 0.5) / 2)), 1e-4);
    auto usual = light<SpotLight>("LightSource \"spot\"");
    EXPECT_FLOAT_EQ(usual.cos_total_width, std::cos(30 * static_cast<float>(pi) / 180));

    auto distant = light<DistantLight>("Rotate 90 1 0 0 LightSource \"distant\" \"float illuminance\" 30");
    EXPECT_LT(length(distant.to_light - Vec3f(0, 1, 0)), 1e-6f);
    EXPECT_NEAR(photometric(distant), 30, 1e-4);
    EXPECT_NEAR(photometric(light<UniformInfiniteLight>("LightSource \"infinite\" \"float illuminance\" 30")),
                30 / pi, 1e-4);
    EXPECT_NEAR(photometric(light<UniformInfiniteLight>("LightSource \"infinite\" \"rgb L\" [ 9 9 9 ]")), 1,
                1e-5);
}

TEST(PbrtLights, AreaLightsOfShapes) {
    SceneDescription d = parse_world(R"(
        LightSource "point"
        AttributeBegin
        AreaLightSource "diffuse" "rgb L" [ 5 5 5 ] "bool twosided" true "float power" 12
        Scale 2 2 2
        Shape "trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 0 4 0 ] "integer indices" [ 0 1 2 0 1 3 ]
        Shape "sphere" "float radius" 3
        AttributeEnd
        Shape "disk")");
    ASSERT_EQ(d.scene.lights.size(), 3u);
    EXPECT_EQ(d.scene.shapes[0].light, 1u);
    EXPECT_EQ(d.scene.shapes[1].light, 2u);
    EXPECT_EQ(d.scene.shapes[2].light, no_index);
    const SceneTables tables(d.scene);
    const SampledWavelengths lambda = SampledWavelengths::sample_visible(0.3f);
    const double areas[] = {2, 8, 4 * pi * 9};
    for (Index i = 0; i < 3; ++i) {
        const Index index = 1 + i / 2;
        const auto& l = std::get<AreaLight>(d.scene.lights[index]);
        EXPECT_TRUE(l.two_sided);
        EXPECT_EQ(l.shape, i / 2);
        EXPECT_EQ(part_count({tables.view(), index}), index == 1 ? 2u : 1u);
        const LightHit hit{.wi = {0, 0, -1}, .part = i % 2, .n = {0, 0, 1}};
        const float radiance = incident_radiance({tables.view(), index}, {}, hit, lambda)[0];
        EXPECT_NEAR(radiance / tables.view().sample(l.spectrum, lambda)[0] *
                        to_photometric(tables.view().spectrum(l.spectrum)),
                    12 / (2 * areas[i] * pi), 1e-5);
    }
}

TEST(PbrtLights, PicturesOnAreaLights) {
    TemporaryFolder folder;
    Image picture(2, 2, {"R", "G", "B"});
    for (int c = 0; c < 3; ++c) {
        picture.set(0, 0, c, 1);
        picture.set(1, 0, c, 3);
        picture.set(0, 1, c, 5);
        picture.set(1, 1, c, 7);
    }
    write_image(folder / "light.exr", picture);
    const std::string light =
        "AreaLightSource \"diffuse\" \"string filename\" \"" + (folder / "light.exr").string() + "\" ";
    const SceneDescription d = parse_world(
        light + "\"float scale\" 2 Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0]" + light +
        "\"float power\" 8 Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0]");
    const SceneTables tables(d.scene);
    const SampledWavelengths lambda = SampledWavelengths::sample_visible(0.3f);
    const float white = RgbColorSpace::srgb().illuminant().sample(lambda)[0] *
                        photometric_scale(Spectrum(RgbColorSpace::srgb().illuminant()));
    const auto radiance = [&](Index index, Vec2f b) {
        const LightHit hit{.wi = {0, 0, -1}, .p = {b.x, b.y, 0}, .n = {0, 0, 1}, .b = b};
        return incident_radiance({tables.view(), index}, {}, hit, lambda)[0] / white;
    };
    // The top row at v = 1; bilinear; clamped at the border.
    EXPECT_NEAR(radiance(0, {0.25f, 0.75f}), 2 * 1, 1e-3);
    EXPECT_NEAR(radiance(0, {0.75f, 0.75f}), 2 * 3, 1e-3);
    EXPECT_NEAR(radiance(0, {0.25f, 0.25f}), 2 * 5, 1e-3);
    EXPECT_NEAR(radiance(0, {0, 0}), 2 * 5, 1e-3);
    EXPECT_NEAR(radiance(0, {0.5f, 0.5f}), 2 * 4, 1e-3);
    EXPECT_NEAR(radiance(0, {1, 0.375f}), 2 * 6, 1e-3);
    // 8 lm over pi and the mean of the picture.
    EXPECT_NEAR(radiance(1, {0.5f, 0.5f}), 8 / pi, 1e-3);
    std::vector<double> powers(1);
    light_powers({tables.view(), 1}, powers);
    const Spectrum illuminant(RgbColorSpace::srgb().illuminant());
    EXPECT_NEAR(powers[0], 8 * visible_mean(illuminant) * double(photometric_scale(illuminant)),
                1e-2 * powers[0]);
}

TEST(PbrtLights, EnvironmentMaps) {
    TemporaryFolder folder;
    Image map(64, 64, {"R", "G", "B"});
    for (float& v : map.f32()) v = 1;
    map.set(0, 0, 0, -1); // counts as 0
    write_image(folder / "map.exr", map);
    write_image(folder / "odd.exr", Image(16, 9, {"R", "G", "B"}));
    Image wide(64, 32, {"R", "G", "B"});
    for (float& v : wide.f32()) v = 1;
    write_image(folder / "wide.exr", wide);
    auto load = [&](const std::string& text, Warnings& warnings) {
        return parse_pbrt("WorldBegin\n" + text, "scene", folder.path(), warnings);
    };
    Warnings warnings;
    SceneDescription d =
        load("Rotate 90 0 1 0 LightSource \"infinite\" \"string filename\" \"map.exr\" \"float scale\" 3 "
             "LightSource \"infinite\" \"string filename\" \"map.exr\" \"float illuminance\" 10",
             warnings);
    ASSERT_EQ(d.scene.environments.size(), 1u);
    EXPECT_EQ(d.scene.environments[0].value(0, 0, 0), 0);
    EXPECT_EQ(warnings.messages().size(), 1u);
    const auto& l = std::get<ImageInfiniteLight>(d.scene.lights[0]);
    EXPECT_EQ(l.environment, 0u);
    double white = to_photometric(Spectrum(RgbColorSpace::srgb().illuminant()));
    EXPECT_NEAR(l.scale * white, 3, 1e-5);
    EXPECT_LT(length(l.world_from_light.vector(Vec3f(0, 0, 1)) - Vec3f(1, 0, 0)), 1e-6f);
    // pbrt takes pi / 2 for the illuminance of a map of 1.
    EXPECT_NEAR(std::get<ImageInfiniteLight>(d.scene.lights[1]).scale * white, 10 / (pi / 2), 0.02);
    EXPECT_EQ(l.layout, EnvironmentLayout::equal_area);
    d = load("Scale 2 2 2 Rotate 90 0 1 0 LightSource \"infinite\" \"string filename\" \"map.exr\" "
             "\"point3 portal\" [0 0 3 0 2 3 4 2 3 4 0 3] "
             "LightSource \"infinite\" \"rgb L\" [1 1 1] \"point3 portal\" [0 0 3 4 0 3 4 2 3 0 2 3]",
             warnings);
    // In world space, whatever turns the map.
    const auto& through = std::get<ImageInfiniteLight>(d.scene.lights[0]).portal;
    ASSERT_TRUE(through);
    EXPECT_EQ(through->area(), 8);
    EXPECT_LT(length(through->normal() - Vec3d{0, 0, 1}), 1e-12);
    EXPECT_TRUE(through->lets_through({1, 1, 2}, {0, 0, 1}));
    const auto& uniform = std::get<UniformInfiniteLight>(d.scene.lights[1]);
    ASSERT_TRUE(uniform.portal);
    EXPECT_LT(length(uniform.portal->normal() - Vec3d{0, 0, -1}), 1e-12);
    EXPECT_NEAR(photometric(uniform, d.scene.spectra), 1, 1e-5);
    Warnings of_wide;
    d = load("LightSource \"infinite\" \"string filename\" \"wide.exr\" \"float illuminance\" 10", of_wide);
    const auto& w = std::get<ImageInfiniteLight>(d.scene.lights[0]);
    EXPECT_EQ(w.layout, EnvironmentLayout::equirectangular);
    EXPECT_EQ(of_wide.messages().size(), 1u);
    EXPECT_NEAR(w.scale * white, 10 / (pi / 2), 0.02);
    Warnings of_odd;
    d = load("LightSource \"infinite\" \"string filename\" \"odd.exr\" \"string layout\" \"equirectangular\" "
             "LightSource \"infinite\" \"string filename\" \"map.exr\" \"string layout\" \"equirectangular\"",
             of_odd);
    for (const Light& told : d.scene.lights)
        EXPECT_EQ(std::get<ImageInfiniteLight>(told).layout, EnvironmentLayout::equirectangular);
    EXPECT_EQ(of_odd.messages().size(), 2u); // odd.exr is black, and map.exr has negative pixels
    EXPECT_THROW(
        load("LightSource \"infinite\" \"string filename\" \"odd.exr\" \"string layout\" \"equal-area\"",
             warnings),
        Error);
    try {
        load("LightSource \"infinite\" \"string filename\" \"odd.exr\"", warnings);
        ADD_FAILURE() << "a map that is neither square nor twice as wide as high was accepted";
    } catch (const Error& e) {
        EXPECT_EQ(std::string(e.what()),
                  "scene:2:24: " + (folder / "odd.exr").string() +
                      " has 16 x 9 pixels; an environment map must be square (equal-area "
                      "octahedral), or twice as wide as high (latitude-longitude)");
    }
}

TEST(PbrtLights, PointLightsWithPictures) {
    TemporaryFolder folder;
    Image map(16, 16, {"R", "G", "B"});
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) map.set(x, y, 1, 3); // the mean of the colours is 1
    write_image(folder / "map.exr", map);
    Image picture(30, 20, {"R", "G", "B"});
    for (float& v : picture.f32()) v = 2;
    write_image(folder / "picture.exr", picture);
    write_image(folder / "black.exr", Image(4, 4, {"R", "G", "B"}));
    Warnings warnings;
    const auto load = [&](const std::string& text) {
        return parse_pbrt("WorldBegin\n" + text, "scene", folder.path(), warnings);
    };
    const SceneDescription d =
        load("LightSource \"infinite\" \"string filename\" \"map.exr\"\n"
             "Translate 1 2 3 Rotate 90 0 0 1\n"
             "LightSource \"goniometric\" \"string filename\" \"map.exr\" \"blackbody I\" 3000 \"float "
             "scale\" 0.5\n"
             "LightSource \"goniometric\" \"string filename\" \"map.exr\" \"float power\" 10\n"
             "LightSource \"projection\" \"string filename\" \"picture.exr\"\n"
             "LightSource \"projection\" \"string filename\" \"picture.exr\" \"float fov\" 50 \"float "
             "power\" 10\n");
    EXPECT_EQ(warnings.messages(), std::vector<std::string>());
    // The grey map and the coloured one are two.
    ASSERT_EQ(d.scene.environments.size(), 3u);
    const auto& g = std::get<GoniometricLight>(d.scene.lights[1]);
    EXPECT_EQ(g.environment, 1u);
    for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(d.scene.environments[1].value(3, 5, c), 1);
    EXPECT_NEAR(photometric(g, d.scene.spectra), 0.5, 1e-5);
    EXPECT_LT(length(g.position() - Vec3f(1, 2, 3)), 1e-6f);
    // The centre of the map, its z, is the light's y, which is -x in the world; y and z are exchanged.
    EXPECT_LT(length(g.world_from_map.vector(Vec3f(0, 0, 1)) - Vec3f(-1, 0, 0)), 1e-6f);
    EXPECT_LT(length(g.world_from_map.vector(Vec3f(0, 1, 0)) - Vec3f(0, 0, 1)), 1e-6f);
    const SceneTables tables(d.scene);
    const SceneView view = tables.view();
    const double white = to_photometric(Spectrum(RgbColorSpace::srgb().illuminant()));
    // `power` is that of all directions together, of a grey map or picture.
    EXPECT_NEAR(photometric(std::get<GoniometricLight>(d.scene.lights[2]), d.scene.spectra) * 4 * pi, 10,
                1e-3);
    const auto& p = std::get<ProjectionLight>(d.scene.lights[3]);
    EXPECT_EQ(p.environment, 2u);
    EXPECT_EQ(p.fov, 90);
    EXPECT_NEAR(p.scale * white, 1, 1e-5);
    EXPECT_LT(length(p.position() - Vec3f(1, 2, 3)), 1e-6f);
    EXPECT_LT(length(p.world_from_light.vector(Vec3f(1, 0, 0)) - Vec3f(0, 1, 0)), 1e-6f);
    const auto& q = std::get<ProjectionLight>(d.scene.lights[4]);
    EXPECT_EQ(q.fov, 50);
    const double b = std::tan(25 * pi / 180), a = 1.5 * b;
    const double solid_angle = 4 * std::asin(a * b / std::sqrt((1 + a * a) * (1 + b * b)));
    EXPECT_NEAR(q.scale * white * 2 * solid_angle, 10, 0.02);
    EXPECT_NEAR(view.light_tables.projection(4).flux(), 2 * solid_angle, 0.002);
    for (const char* type : {"goniometric", "projection"}) {
        try {
            load("LightSource \"" + std::string(type) +
                 "\" \"string filename\" \"black.exr\" \"float power\" 1");
            ADD_FAILURE() << "a black picture was given a power";
        } catch (const Error& e) {
            EXPECT_NE(std::string(e.what()).find("the picture has no light to be scaled"), std::string::npos);
        }
    }
}

} // namespace
} // namespace montelux
