// Directives behind WorldBegin and defaults: the resulting scene.
#include "test/formats/pbrt/parse.h"
#include "test/near.h"
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/scene/scene_digest.h"

namespace montelux {
namespace {

using test::parse;
using test::parse_world;
using test::sphere;

TEST(PbrtDefaults, OfAnEmptyScene) {
    Warnings warnings;
    SceneDescription d = parse("WorldBegin", &warnings);
    EXPECT_EQ(d.film.width, 1280);
    EXPECT_EQ(d.film.height, 720);
    EXPECT_EQ(d.film.crop, (PixelBounds{0, 0, 1280, 720}));
    const auto& filter = std::get<GaussianFilter>(d.film.filter);
    EXPECT_EQ(filter.radius, Vec2f(1.5f, 1.5f));
    EXPECT_EQ(filter.sigma, 0.5f);
    EXPECT_EQ(d.film.iso, 100);
    EXPECT_EQ(d.film.exposure_time, 1);
    EXPECT_EQ(d.film.white_balance, 0);
    EXPECT_TRUE(std::isinf(d.film.max_component_value));
    const auto& camera = std::get<PerspectiveCamera>(d.scene.camera.model);
    EXPECT_EQ(camera.fov, 90);
    EXPECT_EQ(camera.lens_radius, 0);
    EXPECT_EQ(camera.focal_distance, 1e6f);
    EXPECT_FALSE(camera.screen_window || camera.frame_aspect_ratio);
    EXPECT_EQ(d.sampler.spp, 16u);
    EXPECT_EQ(d.sampler.kind, SamplerKind::sobol_blue_noise);
    EXPECT_EQ(d.integrator.max_depth, 5);
    EXPECT_EQ(d.integrator.strategy, Strategy::mis);
    EXPECT_EQ(warnings.messages(),
              std::vector<std::string>{"scene:1:11: the scene has no light; its picture is black"});
}

TEST(PbrtTransforms, OrderAndStack) {
    SceneDescription d = parse_world(R"(
        Translate 1 2 3
        AttributeBegin
            Rotate 90 0 0 1
            Scale 2 2 2
            Shape "sphere"
            CoordinateSystem "here"
        AttributeEnd
        Shape "sphere"
        Identity Shape "sphere"
        CoordSysTransform "here" Shape "sphere"
        Transform [ 1 0 0 0  0 1 0 0  0 0 1 0  5 6 7 1 ] Shape "sphere"
        ConcatTransform [ 0 1 0 0  -1 0 0 0  0 0 1 0  0 0 0 1 ] Shape "sphere"
        TransformBegin Translate 1 1 1 TransformEnd Shape "sphere")");
    auto at = [&](std::size_t i, Vec3f p) { return sphere(d, i).world_from_object.point(p); };
    expect_near(at(0, {1, 0, 0}), {1, 4, 3});
    expect_near(at(1, {1, 0, 0}), {2, 2, 3});
    expect_near(at(2, {1, 0, 0}), {1, 0, 0});
    expect_near(at(3, {1, 0, 0}), {1, 4, 3});
    expect_near(at(4, {1, 0, 0}), {6, 6, 7});
    expect_near(at(5, {1, 0, 0}), {5, 7, 7});
    expect_near(at(6, {1, 0, 0}), {5, 7, 7});
}

TEST(PbrtTransforms, CameraAndItsCoordinateSystem) {
    SceneDescription d = parse(R"(
        LookAt 1 2 3  1 2 10  0 1 0
        Camera "perspective"
        WorldBegin
        CoordSysTransform "camera" Shape "sphere")");
    expect_near(d.scene.camera.world_from_camera.point(Vec3f(0, 0, 1)), {1, 2, 4});
    expect_near(sphere(d).world_from_object.point(Vec3f(0, 0, 2)), {1, 2, 5});
    // pbrt's camera space is left-handed: with +z forward and +y up, +x goes to the right.
    expect_near(d.scene.camera.world_from_camera.vector(Vec3f(1, 0, 0)), {1, 0, 0});
}

TEST(PbrtObjects, DefinitionsAndInstances) {
    Warnings warnings;
    SceneDescription d = parse_world(R"(
        ObjectInstance "thing"
        Translate 1 0 0
        ObjectBegin "thing"
            Translate 0 1 0
            AreaLightSource "diffuse"
            Shape "sphere"
            Shape "trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 ]
        ObjectEnd
        Shape "sphere"
        Scale 2 2 2
        ObjectInstance "thing")",
                                     &warnings);
    ASSERT_EQ(d.scene.objects.size(), 1u);
    EXPECT_EQ(d.scene.objects[0].shapes, (std::vector<Index>{0, 1}));
    EXPECT_EQ(d.scene.world_shapes, std::vector<Index>{2});
    expect_near(sphere(d, 0).world_from_object.point(Vec3f()), {1, 1, 0});
    expect_near(d.scene.meshes[0].positions[0], {1, 1, 0});
    expect_near(sphere(d, 1).world_from_object.point(Vec3f()), {1, 0, 0});
    ASSERT_EQ(d.scene.instances.size(), 2u);
    expect_near(d.scene.instances[0].world_from_object.point(Vec3f(1, 1, 1)), {1, 1, 1});
    expect_near(d.scene.instances[1].world_from_object.point(Vec3f(1, 1, 1)), {3, 2, 2});
    EXPECT_TRUE(d.scene.lights.empty());
    EXPECT_EQ(d.scene.shapes[0].light, no_index);
    EXPECT_EQ(warnings.messages().size(), 2u); // area light in an object, no light at all
}

TEST(PbrtAttributes, DefaultsOfShapesMaterialsLights) {
    SceneDescription d = parse_world(R"(
        Attribute "shape" "float radius" 3
        Attribute "material" "float roughness" 0.5 "bool remaproughness" false
        Attribute "light" "float scale" 2
        AttributeBegin
            Attribute "shape" "float radius" 4
            Shape "sphere"
        AttributeEnd
        Material "dielectric"
        Shape "sphere"
        Shape "sphere" "float radius" 5
        Material "diffuse"
        LightSource "point")");
    EXPECT_EQ(sphere(d, 0).radius, 4);
    EXPECT_EQ(sphere(d, 1).radius, 3);
    EXPECT_EQ(sphere(d, 2).radius, 5);
    const auto& m = std::get<DielectricMaterial>(d.scene.materials[d.scene.shapes[1].material]);
    EXPECT_EQ(m.roughness.u.value, 0.5f);
    EXPECT_FALSE(m.roughness.remap);
    const auto& light = std::get<PointLight>(d.scene.lights[0]);
    EXPECT_NEAR(light.scale * to_photometric(spectrum_of(light.spectrum, d.scene.spectra)), 2, 1e-5);
}

// A name that fits some plugin of the kind applies to later directives; one that fits none is a mistake,
// reported once like an unknown parameter of a plugin.
TEST(PbrtAttributes, NamesThatFitNoPluginGiveAWarning) {
    Warnings warnings;
    SceneDescription d = parse_world(R"(LightSource "infinite"
        Attribute "shape" "float radios" 3
        Attribute "shape" "float radios" 4 "float innerradius" 0.5 "string basis" "bspline"
        Attribute "light" "float scaale" 2 "float fov" 20
        Attribute "material" "float radius" 0.5 "float interface.roughness" 0.5
        Attribute "medium" "float gg" 0.5 "float g" 0.5
        Attribute "texture" "string encodin" "linear" "float octaves" 2
        Shape "sphere")",
                                     &warnings);
    EXPECT_EQ(
        warnings.messages(),
        (std::vector<std::string>{
            "scene:3:27: no shape has a parameter 'radios' (did you mean 'radius'?); it is ignored",
            "scene:5:27: no light has a parameter 'scaale' (did you mean 'scale'?); it is ignored",
            "scene:6:30: no material has a parameter 'radius'; it is ignored",
            "scene:7:28: no medium has a parameter 'gg' (did you mean 'g'?); it is ignored",
            "scene:8:29: no texture has a parameter 'encodin' (did you mean 'encoding'?); it is ignored"}));
    EXPECT_EQ(sphere(d, 0).radius, 1);
}

TEST(PbrtFiles, TheDigestIsOfValues) {
    auto digest = [](std::string_view world) { return digest_of(parse_world(world).scene); };
    EXPECT_EQ(digest("Shape \"sphere\""), digest("# a ball\nShape \"sphere\" \"float radius\" 1"));
    EXPECT_NE(digest("Shape \"sphere\""), digest("Shape \"disk\""));
    EXPECT_NE(digest("Shape \"sphere\""), digest("Shape \"sphere\" \"float radius\" 2"));
}

} // namespace
} // namespace montelux
