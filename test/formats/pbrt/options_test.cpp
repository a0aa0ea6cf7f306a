// Directives before WorldBegin: film, camera, sampler, integrator, options and layers.
#include "test/formats/pbrt/parse.h"
#include <gtest/gtest.h>
#include <iterator>
#include <string>
#include <vector>

#include "montelux/scene/scene_names.h"

namespace montelux {
namespace {

using test::error_of;
using test::parse;
using test::parse_world;

TEST(PbrtOptions, FilmCameraSamplerIntegratorFilter) {
    SceneDescription d = parse(R"(
        Option "integer seed" 7
        Film "rgb" "integer xresolution" [ 100 ] "integer yresolution" 50 "string filename" "out.exr"
            "float cropwindow" [ 0.101 0.5 0 1 ] "float iso" 200 "float maxcomponentvalue" 10
        Camera "perspective" "float fov" 39.5 "float lensradius" .25 "float focaldistance" 3
            "float screenwindow" [ -2 2 -1 1 ] "float shutterclose" 0.5
        Sampler "stratified" "integer xsamples" 3 "integer ysamples" 5
        Integrator "simplepath" "integer maxdepth" 12 "bool samplelights" false
        PixelFilter "mitchell" "float xradius" 3 "float B" 0.5
        WorldBegin)");
    EXPECT_EQ(d.film.width, 100);
    EXPECT_EQ(d.film.crop, (PixelBounds{11, 0, 50, 50}));
    EXPECT_EQ(d.film.iso, 200);
    EXPECT_EQ(d.film.exposure_time, 0.5f);
    EXPECT_EQ(d.film.max_component_value, 10);
    EXPECT_EQ(d.output_file, "out.exr");
    const auto& camera = std::get<PerspectiveCamera>(d.scene.camera.model);
    EXPECT_EQ(camera.fov, 39.5f);
    EXPECT_EQ(camera.lens_radius, 0.25f);
    EXPECT_EQ(camera.focal_distance, 3);
    EXPECT_EQ(camera.screen_window->x_min, -2);
    EXPECT_EQ(d.sampler.kind, SamplerKind::stratified);
    EXPECT_EQ(d.sampler.spp, 15u);
    EXPECT_EQ(d.sampler.seed, 7u);
    EXPECT_EQ(d.integrator.max_depth, 12);
    EXPECT_EQ(d.integrator.strategy, Strategy::bsdf);
    const auto& filter = std::get<MitchellFilter>(d.film.filter);
    EXPECT_EQ(filter.radius, Vec2f(3, 2));
    EXPECT_EQ(filter.b, 0.5f);
    EXPECT_FLOAT_EQ(filter.c, 1.0f / 3);
    d = parse(
        "Film \"rgb\" \"integer pixelbounds\" [ 10 20 -5 30 ] Camera \"spherical\" \"string mapping\" "
        "\"equirectangular\" Sampler \"halton\" \"integer seed\" 3 Option \"integer seed\" 9 WorldBegin");
    EXPECT_EQ(d.film.crop, (PixelBounds{10, 0, 20, 30}));
    EXPECT_EQ(std::get<SphericalCamera>(d.scene.camera.model).mapping,
              SphericalCamera::Mapping::equirectangular);
    EXPECT_EQ(d.sampler.seed, 3u);
    d = parse(
        "Camera \"orthographic\" PixelFilter \"sinc\" Integrator \"bdpt\" \"integer maxdepth\" 3 WorldBegin");
    EXPECT_TRUE(std::holds_alternative<OrthographicCamera>(d.scene.camera.model));
    EXPECT_EQ(std::get<LanczosFilter>(d.film.filter).radius, Vec2f(4, 4));
    EXPECT_EQ(d.integrator.max_depth, 3);
}

// pbrt ignores '-', '_' and capitals.
TEST(PbrtOptions, SpellingsOfOptions) {
    EXPECT_EQ(parse("Option \"integer Seed\" 7 WorldBegin").sampler.seed, 7u);
    EXPECT_EQ(parse("Option \"integer se-e_d\" 7 WorldBegin").sampler.seed, 7u);
    Warnings warnings;
    parse("Option \"bool disable-pixel-jitter\" true Option \"bool disablePixelJitter\" true\n"
          "Option \"string render_coord_sys\" \"camera\" Option \"string rendercoordsys\" \"world\"\n"
          "Option \"string RenderCoordSys\" \"cameraworld\" WorldBegin LightSource \"point\"",
          &warnings);
    EXPECT_EQ(
        warnings.messages(),
        std::vector<std::string>{"scene:1:8: option 'disable-pixel-jitter' is not supported; it is ignored"});
    EXPECT_EQ(error_of("Option \"float Seed\" 7 WorldBegin"),
              "scene:1:8: option 'Seed' has type float; expected 1 integer");
    EXPECT_EQ(error_of("Option \"integer rendercoordsys\" 7 WorldBegin"),
              "scene:1:8: option 'rendercoordsys' has type integer; expected 1 string");
    EXPECT_EQ(
        error_of("Option \"string rendercoordsys\" \"wolrd\" WorldBegin"),
        "scene:1:8: option 'rendercoordsys' is 'wolrd'; expected one of camera, cameraworld, world (did you "
        "mean 'world'?)");
    EXPECT_EQ(error_of("Option \"integer Sed\" 7 WorldBegin"),
              "scene:1:8: unknown option 'Sed' (did you mean 'seed'?)");
}

TEST(PbrtOptions, LightSamplers) {
    const auto sampling = [](const std::string& name) {
        return parse("Integrator \"path\" \"string lightsampler\" \"" + name + "\"\nWorldBegin\n")
            .integrator.light_sampling;
    };
    EXPECT_EQ(sampling("uniform"), LightSampling::uniform);
    EXPECT_EQ(sampling("power"), LightSampling::power);
    EXPECT_EQ(sampling("bvh"), LightSampling::tree);
    EXPECT_EQ(sampling("exhaustive"), LightSampling::tree);
    EXPECT_EQ(parse("Integrator \"path\"\nWorldBegin\n").integrator.light_sampling, LightSampling::tree);
    EXPECT_THROW(sampling("tree"), Error);
}

TEST(PbrtOptions, SensorsBucketsAndOcclusion) {
    const std::string end = " WorldBegin LightSource \"point\"";
    SceneDescription d = parse("Film \"rgb\"" + end);
    EXPECT_EQ(d.film.sensor, "cie1931");
    EXPECT_FALSE(d.film.spectral);
    EXPECT_FALSE(d.integrator.occlusion);
    EXPECT_FALSE(d.integrator.regularize);
    d = parse("Film \"spectral\" \"string sensor\" \"sony_ilce_7m3\" \"integer nbuckets\" 30 \"float "
              "lambdamin\" 400 "
              "\"float lambdamax\" 700 Integrator \"path\" \"bool regularize\" true" +
              end);
    EXPECT_EQ(d.film.sensor, "sony_ilce_7m3");
    ASSERT_TRUE(d.film.spectral);
    EXPECT_EQ(d.film.spectral->buckets, 30);
    EXPECT_EQ(d.film.spectral->lambda_min, 400);
    EXPECT_EQ(d.film.spectral->lambda_max, 700);
    EXPECT_TRUE(d.integrator.regularize);
    d = parse("Film \"spectral\"" + end);
    EXPECT_EQ(d.film.spectral->buckets, 16);
    EXPECT_EQ(d.film.spectral->lambda_min, 360);
    EXPECT_EQ(d.film.spectral->lambda_max, 830);

    d = parse("Film \"rgb\" \"float iso\" 400 \"float whitebalance\" 5000 \"float exposuretime\" 0.25 "
              "Camera \"perspective\" \"float shutteropen\" 0.5" +
              end);
    EXPECT_EQ(d.film.iso, 400);
    EXPECT_EQ(d.film.white_balance, 5000);
    EXPECT_EQ(d.film.exposure_time, 0.125f); // half as long by the shutter
    EXPECT_EQ(test::error_of("Film \"rgb\" \"float whitebalance\" 1999" + end).substr(0, 48),
              "scene:1:12: parameter 'whitebalance' is below 20");
    EXPECT_EQ(test::error_of("Film \"rgb\" \"float exposuretime\" 0" + end),
              "scene:1:12: parameter 'exposuretime' must be positive");
    EXPECT_EQ(test::error_of("Film \"rgb\" \"float iso\" 0" + end),
              "scene:1:12: parameter 'iso' must be positive");

    Warnings warnings;
    d = parse("Integrator \"ambientocclusion\" \"bool cossample\" false \"float maxdistance\" 3 WorldBegin",
              &warnings);
    ASSERT_TRUE(d.integrator.occlusion);
    EXPECT_FALSE(d.integrator.occlusion->cosine);
    EXPECT_EQ(d.integrator.occlusion->max_distance, 3);
    EXPECT_TRUE(warnings.messages().empty()); // no light is needed
    EXPECT_EQ(test::error_of("Integrator \"ao\" \"float maxdistance\" 0 WorldBegin"),
              "scene:1:17: parameter 'maxdistance' must be positive");
    warnings = {};
    parse("Integrator \"sppm\"" + end, &warnings);
    ASSERT_EQ(warnings.messages().size(), 1u);
    EXPECT_NE(warnings.messages()[0].find("integrator 'sppm': the scene is rendered with 'path'"),
              std::string::npos);
}

TEST(PbrtOptions, IntegratorsThatTraceLight) {
    const std::string light = "WorldBegin LightSource \"point\"";
    Warnings warnings;
    SceneDescription d = parse("Integrator \"bdpt\" \"integer maxdepth\" 7 " + light, &warnings);
    EXPECT_EQ(d.integrator.method, IntegratorKind::bidirectional);
    EXPECT_EQ(d.integrator.max_depth, 7);
    EXPECT_TRUE(warnings.messages().empty());
    d = parse("Integrator \"lightpath\" " + light, &warnings);
    EXPECT_EQ(d.integrator.method, IntegratorKind::light_tracing);
    ASSERT_EQ(warnings.messages().size(), 1u);
    EXPECT_NE(warnings.messages()[0].find("straight from a mirror"), std::string::npos);
    EXPECT_EQ(parse("Integrator \"path\" " + light).integrator.method, IntegratorKind::path);
    // What they cannot do is rendered with paths from the camera.
    warnings = {};
    d = parse("Camera \"spherical\" Integrator \"bdpt\" " + light, &warnings);
    EXPECT_EQ(d.integrator.method, IntegratorKind::path);
    ASSERT_EQ(warnings.messages().size(), 1u);
    EXPECT_NE(
        warnings.messages()[0].find("'bidirectional': the scene is rendered with 'path': spherical cameras"),
        std::string::npos)
        << warnings.messages()[0];
}

// Metropolis takes its samples per pixel from the integrator, as in pbrt.
TEST(PbrtOptions, MetropolisIntegrator) {
    Warnings warnings;
    SceneDescription d = parse("Integrator \"mlt\" \"integer maxdepth\" 9 \"integer mutationsperpixel\" 40 "
                               "\"float largestepprobability\" 0.2 \"integer chains\" 500 "
                               "Sampler \"sobol\" \"integer pixelsamples\" 7 "
                               "WorldBegin LightSource \"point\"",
                               &warnings);
    EXPECT_EQ(d.integrator.method, IntegratorKind::metropolis);
    EXPECT_EQ(d.integrator.max_depth, 9);
    EXPECT_EQ(d.integrator.large_step_probability, 0.2f);
    EXPECT_EQ(d.sampler.spp, 40u);
    ASSERT_EQ(warnings.messages().size(), 1u);
    EXPECT_NE(warnings.messages()[0].find("'chains' is ignored"), std::string::npos);
    d = parse("Integrator \"mlt\" WorldBegin LightSource \"point\"");
    EXPECT_EQ(d.sampler.spp, 100u);
    EXPECT_EQ(d.integrator.large_step_probability, 0);
    EXPECT_NE(test::error_of("Integrator \"mlt\" \"float largestepprobability\" 1.5 WorldBegin")
                  .find("between 0 and 1"),
              std::string::npos);
    d = parse("Integrator \"volpath\" WorldBegin LightSource \"point\"");
    EXPECT_EQ(d.integrator.method, IntegratorKind::path);
}

// Everything that is read but has no effect gives a warning.
TEST(PbrtOptions, IgnoredOptionsGiveAWarning) {
    Warnings warnings;
    parse(R"(ColorSpace "rec2020"
Film "gbuffer" "bool savefp16" true "string coordinatesystem" "camera"
Accelerator "bvh" "integer maxnodeprims" 4
Integrator "volpath" "bool regularize" true "string lightsampler" "exhaustive"
Sampler "sobol" "string randomization" "none"
Option "bool disablepixeljitter" true
WorldBegin TransformBegin TransformEnd LightSource "point"
WorldEnd)",
          &warnings);
    const char* expected[] = {
        "scene:2:1: the film's colour space is sRGB",
        "scene:3:1: 'Accelerator' is ignored",
        "scene:6:8: option 'disablepixeljitter' is not supported; it is ignored",
        "scene:4:22: 'regularize' widens the reflections",
        "scene:4:45: lights are chosen by a tree",
        "scene:5:17: the points are randomised all the same",
        "scene:7:12: TransformBegin is deprecated",
        "scene:8:1: WorldEnd belongs to pbrt-v3",
    };
    ASSERT_EQ(warnings.messages().size(), std::size(expected));
    for (std::size_t i = 0; i < std::size(expected); ++i)
        EXPECT_EQ(warnings.messages()[i].substr(0, std::string(expected[i]).size()), expected[i]);
}

TEST(PbrtOptions, FilmChoosesLayersAndTheirSpace) {
    const auto layers = [](const std::string& film) {
        return parse("Film " + film + "\nWorldBegin\n").film.layers;
    };
    EXPECT_EQ(layers("\"rgb\""), LayerSettings{});
    EXPECT_EQ(layers("\"rgb\" \"bool savefp16\" true"), LayerSettings{.half = true});
    EXPECT_EQ(layers("\"rgb\" \"bool savefp16\" false"), LayerSettings{});
    EXPECT_EQ(layers("\"gbuffer\""), (LayerSettings{.set = LayerSet::gbuffer(), .in_camera_space = true}));
    EXPECT_EQ(layers("\"gbuffer\" \"string coordinatesystem\" \"world\""),
              LayerSettings{.set = LayerSet::gbuffer()});
    EXPECT_THROW(layers("\"gbuffer\" \"string coordinatesystem\" \"object\""), Error);
}

TEST(PbrtOptions, ShapesMaterialsObjectsAndLightsHaveNames) {
    const Scene named = parse_world(R"(
        MakeNamedMaterial "gold" "string type" "conductor"
        Material "diffuse" Shape "sphere"
        NamedMaterial "gold"
        AttributeBegin
            Attribute "shape" "string name" "globe"
            Shape "sphere"
            Shape "sphere" "string name" "moon"
        AttributeEnd
        ObjectBegin "tree" Shape "disk" ObjectEnd
        ObjectInstance "tree"
        LightSource "point" "string group" "key"
        LightSource "distant"
        AttributeBegin
            Attribute "light" "string group" "lamps"
            AreaLightSource "diffuse" Shape "disk"
            LightSource "spot"
        AttributeEnd
        LightSource "sky" "string group" "outside")")
                            .scene;
    EXPECT_EQ(named.shape_names, (std::vector<std::string>{"", "globe", "moon"}));
    EXPECT_EQ(shape_name(named, 1), "globe");
    EXPECT_EQ(material_name(named, named.shapes[1].material), "gold");
    EXPECT_NE(material_name(named, named.shapes[0].material), "gold");
    EXPECT_EQ(instance_names(named), std::vector<std::string>{"tree:0"});
    ASSERT_GE(named.lights.size(), 5u);
    const std::vector<std::string> groups{"key", "", "lamps", "lamps", "outside"};
    for (std::size_t i = 0; i < groups.size(); ++i) EXPECT_EQ(named.light_groups[i], groups[i]) << i;
    EXPECT_EQ(named.light_groups.back(), "outside");
}

} // namespace
} // namespace montelux
