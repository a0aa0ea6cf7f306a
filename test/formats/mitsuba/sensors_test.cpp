// Sensors, films, samplers and integrators of Mitsuba scenes.
#include "test/formats/mitsuba/whole_scene.h"
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/formats/mitsuba/integrators.h"
#include "montelux/mc/math/constants.h"
#include "montelux/scene/camera/camera.h"

namespace montelux::mitsuba_sensors {
namespace {

using test::load_scene_text;
using test::scene_text_error;
using test::WholeScene;

constexpr std::string_view film_300_200 =
    R"(<film type="hdrfilm"><integer name="width" value="300"/><integer name="height" value="200"/></film>)";

std::string sensor(const std::string& type, const std::string& content) {
    return "<sensor type=\"" + type + "\">" + content + std::string(film_300_200) + "</sensor>";
}

// The direction, or for `place` the origin, of the ray through a point of the film.
Vec3f ray_of(const SceneDescription& d, Point2f film, bool place = false) {
    const Camera camera(d.scene.camera, d.film.width, d.film.height);
    const CameraRay ray = camera.generate_ray(film, {0.5f, 0.5f}, 0);
    return place ? ray.o : ray.d;
}

void expect_close(Vec3f a, Vec3f b, float tolerance = 1e-5f) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}

// Along +z of the sensor's space, with +x to the left.
TEST(MitsubaSensors, XPointsToTheLeft) {
    const WholeScene s = load_scene_text(sensor("perspective", R"(<float name="fov" value="90"/>)"));
    EXPECT_TRUE(s.description.has_camera);
    expect_close(ray_of(s.description, {150, 100}), {0, 0, 1});
    // The left edge, 45 degrees off.
    expect_close(ray_of(s.description, {0, 100}), normalize(Vec3f(1, 0, 1)));
    expect_close(ray_of(s.description, {150, 0}), normalize(Vec3f(0, 2.0f / 3, 1)));
    EXPECT_TRUE(s.warnings.empty() || s.warnings.size() == 1); // no shapes
}

TEST(MitsubaSensors, LookAt) {
    const WholeScene s = load_scene_text(sensor("perspective", R"(<float name="fov" value="90"/>
        <transform name="to_world"><lookat origin="1, 2, 3" target="1, 2, 0" up="0, 1, 0"/></transform>)"));
    expect_close(ray_of(s.description, {150, 100}, true), {1, 2, 3});
    expect_close(ray_of(s.description, {150, 100}), {0, 0, -1});
    expect_close(ray_of(s.description, {0, 100}), normalize(Vec3f(-1, 0, -1)));
}

// The tangent of half the angle across the width, by the axis of 'fov': the film is 3 wide and 2 high.
TEST(MitsubaSensors, FieldsOfView) {
    const double tan20 = std::tan(20 * pi / 180);
    const auto half_width = [](const std::string& content) {
        const WholeScene s = load_scene_text(sensor("perspective", content));
        const Vec3f d = ray_of(s.description, {0, 100});
        return double(d.x / d.z);
    };
    const auto of_axis = [&](const std::string& axis) {
        return half_width(R"(<float name="fov" value="40"/><string name="fov_axis" value=")" + axis + "\"/>");
    };
    EXPECT_NEAR(half_width(R"(<float name="fov" value="40"/>)"), tan20, 1e-6);
    EXPECT_NEAR(of_axis("x"), tan20, 1e-6);
    EXPECT_NEAR(of_axis("larger"), tan20, 1e-6);
    EXPECT_NEAR(of_axis("y"), 1.5 * tan20, 1e-6);
    EXPECT_NEAR(of_axis("smaller"), 1.5 * tan20, 1e-6);
    EXPECT_NEAR(of_axis("diagonal"), tan20 * 3 / std::sqrt(13.0), 1e-6);
    // A picture of 36 mm x 24 mm has the aspect of the film: half of 36 mm at the focal length.
    EXPECT_NEAR(half_width(""), 18.0 / 50, 1e-6);
    EXPECT_NEAR(half_width(R"(<string name="focal_length" value="28mm"/>)"), 18.0 / 28, 1e-6);
    EXPECT_NEAR(half_width(R"(<string name="focal_length" value="35"/>)"), 18.0 / 35, 1e-6);
}

TEST(MitsubaSensors, PrincipalPoint) {
    const WholeScene s = load_scene_text(sensor("perspective", R"(<float name="fov" value="90"/>
        <float name="principal_point_offset_x" value="0.1"/>
        <float name="principal_point_offset_y" value="-0.2"/>)"));
    // A pixel shows what would be 0.1 of the width further to the right, and 0.2 of the height further up.
    const float x = -0.1f * 2, y = 0.2f * 2 * 2 / 3;
    expect_close(ray_of(s.description, {150, 100}), normalize(Vec3f(x, y, 1)));
}

TEST(MitsubaSensors, ThinLens) {
    const WholeScene s = load_scene_text(sensor("thinlens", R"(<float name="fov" value="40"/>
        <float name="aperture_radius" value="0.25"/><float name="focus_distance" value="7"/>)"));
    const auto& camera = std::get<PerspectiveCamera>(s.scene().camera.model);
    EXPECT_FLOAT_EQ(camera.lens_radius, 0.25f);
    EXPECT_FLOAT_EQ(camera.focal_distance, 7);
    EXPECT_NE(scene_text_error(sensor("thinlens", "")).find("needs the property 'aperture_radius'"),
              std::string::npos);
}

TEST(MitsubaSensors, Orthographic) {
    const WholeScene s = load_scene_text(sensor("orthographic", R"(<transform name="to_world">
        <scale x="10" y="10"/><translate z="-4"/></transform>)"));
    expect_close(ray_of(s.description, {0, 0}, true), {10, 10 * 2.0f / 3, -4});
    expect_close(ray_of(s.description, {300, 200}, true), {-10, -10 * 2.0f / 3, -4});
    expect_close(ray_of(s.description, {300, 200}), {0, 0, 1});
}

TEST(MitsubaSensors, AreChosenByIdOrNumber) {
    const auto two = R"(<sensor type="perspective" id="front"><float name="fov" value="30"/></sensor>
        <sensor type="orthographic" id="plan"/>)";
    const auto is_plan = [&](const LoadOptions& options) {
        return std::holds_alternative<OrthographicCamera>(
            load_scene_text(two, {}, options).scene().camera.model);
    };
    EXPECT_FALSE(is_plan({}));
    EXPECT_TRUE(is_plan({.camera = "plan"}));
    EXPECT_TRUE(is_plan({.camera = "1"}));
    EXPECT_FALSE(is_plan({.camera = "0"}));
    EXPECT_EQ(
        scene_text_error(two, {}, {.camera = "plam"}),
        "scene.xml:1:1: there is no camera 'plam' (did you mean 'plan'?); expected 0 'front', 1 'plan'");
}

TEST(MitsubaSensors, OthersAreRefused) {
    EXPECT_NE(scene_text_error("<sensor type=\"batch\"/>").find("is not supported"), std::string::npos);
    EXPECT_NE(scene_text_error("<sensor type=\"perspectiv\"/>").find("did you mean 'perspective'"),
              std::string::npos);
    EXPECT_NE(scene_text_error(sensor("perspective", R"(<float name="fov" value="180"/>)"))
                  .find("not between 0 and 180"),
              std::string::npos);
}

TEST(MitsubaFilms, Defaults) {
    const WholeScene s = load_scene_text("<sensor type=\"perspective\"/>");
    const FilmSettings& film = s.description.film;
    EXPECT_EQ(film.width, 768);
    EXPECT_EQ(film.height, 576);
    EXPECT_EQ(film.crop, (PixelBounds{0, 0, 768, 576}));
    EXPECT_FLOAT_EQ(std::get<GaussianFilter>(film.filter).sigma, 0.5f);
    EXPECT_FLOAT_EQ(std::get<GaussianFilter>(film.filter).radius.x, 2);
    EXPECT_EQ(s.description.sampler.spp, 4u);
    EXPECT_EQ(s.description.integrator.max_depth, mitsuba::unlimited_depth);
}

TEST(MitsubaFilms, SizesAndFilters) {
    const auto film = [](const std::string& content) {
        return load_scene_text("<sensor type=\"perspective\"><film type=\"hdrfilm\">" + content +
                               "</film></sensor>")
            .description.film;
    };
    const FilmSettings cropped = film(R"(<integer name="width" value="40"/><integer name="height" value="30"/>
        <integer name="crop_offset_x" value="5"/><integer name="crop_offset_y" value="6"/>
        <integer name="crop_width" value="7"/><integer name="crop_height" value="8"/>
        <string name="pixel_format" value="rgba"/>)");
    EXPECT_EQ(cropped.width, 40);
    EXPECT_EQ(cropped.crop, (PixelBounds{5, 6, 12, 14}));
    EXPECT_TRUE(std::holds_alternative<BoxFilter>(film("<rfilter type=\"box\"/>").filter));
    EXPECT_FLOAT_EQ(std::get<TriangleFilter>(film("<rfilter type=\"tent\"/>").filter).radius.x, 1);
    const FilmSettings soft =
        film(R"(<rfilter type="gaussian"><float name="stddev" value="0.75"/></rfilter>)");
    EXPECT_FLOAT_EQ(std::get<GaussianFilter>(soft.filter).radius.y, 3);
    const auto mitchell = std::get<MitchellFilter>(
        film(R"(<rfilter type="mitchell"><float name="B" value="0.2"/></rfilter>)").filter);
    EXPECT_FLOAT_EQ(mitchell.b, 0.2f);
    EXPECT_FLOAT_EQ(mitchell.c, 1.0f / 3);
    EXPECT_FLOAT_EQ(std::get<MitchellFilter>(film("<rfilter type=\"catmullrom\"/>").filter).c, 0.5f);
    const auto lanczos = std::get<LanczosFilter>(film("<rfilter type=\"lanczos\"/>").filter);
    EXPECT_FLOAT_EQ(lanczos.radius.x, 3);
    EXPECT_FLOAT_EQ(lanczos.tau, 3);
    EXPECT_NE(scene_text_error(R"(<sensor type="perspective"><film type="hdrfilm">
        <integer name="crop_width" value="800"/></film></sensor>)")
                  .find("'crop_width' is 800; expected an integer from 1 to 768"),
              std::string::npos);
}

TEST(MitsubaFilms, Samplers) {
    const auto read = [](const std::string& type, bool& warns) {
        const WholeScene s =
            load_scene_text("<sensor type=\"perspective\"><sampler type=\"" + type +
                            R"("><integer name="sample_count" value="25"/></sampler></sensor>)");
        warns = s.warns("Sobol'");
        return s.description.sampler;
    };
    bool warns = true;
    EXPECT_EQ(read("independent", warns).kind, SamplerKind::independent);
    EXPECT_FALSE(warns);
    EXPECT_EQ(read("stratified", warns).spp, 25u);
    EXPECT_FALSE(warns);
    EXPECT_EQ(read("ldsampler", warns).kind, SamplerKind::sobol);
    EXPECT_TRUE(warns);
}

TEST(MitsubaFilms, SeedsOfSamplers) {
    const auto seed = [](const std::string& type, const std::string& properties) {
        return load_scene_text("<sensor type=\"perspective\"><sampler type=\"" + type + "\">" + properties +
                               "</sampler></sensor>")
            .description.sampler.seed;
    };
    for (const char* type : {"independent", "stratified", "ldsampler"}) {
        EXPECT_EQ(seed(type, ""), 0u) << type;
        EXPECT_EQ(seed(type, R"(<integer name="seed" value="7"/>)"), 7u) << type;
        EXPECT_EQ(seed(type, R"(<integer name="seed" value="9000000001"/>)"), 9000000001u) << type;
    }
}

TEST(MitsubaIntegrators, DepthCountsSegments) {
    const auto depth = [](const std::string& type, const char* value) {
        return load_scene_text("<integrator type=\"" + type + R"("><integer name="max_depth" value=")" +
                               value + "\"/></integrator>")
            .description.integrator.max_depth;
    };
    EXPECT_EQ(depth("path", "1"), 0);
    EXPECT_EQ(depth("path", "2"), 1);
    EXPECT_EQ(depth("volpath", "9"), 8);
    EXPECT_EQ(depth("volpathmis", "-1"), mitsuba::unlimited_depth);
    EXPECT_NE(
        scene_text_error(R"(<integrator type="path"><integer name="max_depth" value="0"/></integrator>)"),
        "");
}

TEST(MitsubaIntegrators, DirectAndWrappers) {
    const auto strategy = [](const std::string& content) {
        const IntegratorSettings s =
            load_scene_text("<integrator type=\"direct\">" + content + "</integrator>")
                .description.integrator;
        EXPECT_EQ(s.max_depth, 1);
        return s.strategy;
    };
    EXPECT_EQ(strategy(""), Strategy::mis);
    EXPECT_EQ(strategy(R"(<integer name="emitter_samples" value="0"/>)"), Strategy::bsdf);
    EXPECT_EQ(strategy(R"(<integer name="bsdf_samples" value="0"/>)"), Strategy::light);
    for (const auto& [type, counts] : {std::pair("path", true), {"volpath", false}, {"volpathmis", false}})
        EXPECT_EQ(load_scene_text("<integrator type=\"" + std::string(type) + "\"/>")
                      .description.integrator.count_passages,
                  counts)
            << type;
    const WholeScene moment = load_scene_text(R"(<integrator type="moment"><integrator type="path">
        <integer name="max_depth" value="4"/></integrator></integrator>)");
    EXPECT_EQ(moment.description.integrator.max_depth, 3);
    EXPECT_FALSE(moment.description.integrator.background);
    const WholeScene hidden = load_scene_text(
        R"(<integrator type="path"><boolean name="hide_emitters" value="true"/></integrator>)");
    EXPECT_TRUE(hidden.description.integrator.background);
    EXPECT_NE(scene_text_error("<integrator type=\"stokes\"/>").find("polarization"), std::string::npos);
}

TEST(MitsubaSettings, WhatIsMissingIsLeftToTheStudio) {
    const WholeScene s = load_scene_text("<shape type=\"sphere\"/>");
    EXPECT_FALSE(s.description.has_camera);
    EXPECT_FALSE(s.description.has_lights);
    EXPECT_TRUE(s.description.wants_studio);
    EXPECT_TRUE(load_scene_text("<emitter type=\"constant\"/>").description.has_lights);
}

} // namespace
} // namespace montelux::mitsuba_sensors
