// Directives and defaults: the resulting scene.
#include "test/formats/pbrt/parse.h"
#include "test/near.h"
#include <cmath>
#include <gtest/gtest.h>
#include <string>

#include "montelux/scene/scene_digest.h"
#include "montelux/scene/scene_names.h"
#include "montelux/spectrum/rgb_colorspace.h"

namespace montelux {
namespace {

using test::error_of;
using test::parse;
using test::parse_world;

const Sphere& sphere(const SceneDescription& d, std::size_t i = 0) {
    return std::get<Sphere>(d.scene.quadrics.at(i));
}

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

// Everything that is read but has no effect gives a warning.
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
    parse("Integrator \"bdpt\"" + end, &warnings);
    ASSERT_EQ(warnings.messages().size(), 1u);
    EXPECT_NE(warnings.messages()[0].find("integrator 'bdpt': the scene is rendered with 'path'"),
              std::string::npos);
}

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
    const Scene scene = parse_world(R"(
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
    EXPECT_EQ(scene.shape_names, (std::vector<std::string>{"", "globe", "moon"}));
    EXPECT_EQ(shape_name(scene, 1), "globe");
    EXPECT_EQ(material_name(scene, scene.shapes[1].material), "gold");
    EXPECT_NE(material_name(scene, scene.shapes[0].material), "gold");
    EXPECT_EQ(instance_names(scene), std::vector<std::string>{"tree:0"});
    ASSERT_GE(scene.lights.size(), 5u);
    const std::vector<std::string> groups{"key", "", "lamps", "lamps", "outside"};
    for (std::size_t i = 0; i < groups.size(); ++i) EXPECT_EQ(scene.light_groups[i], groups[i]) << i;
    EXPECT_EQ(scene.light_groups.back(), "outside");
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

TEST(PbrtShapes, Quadrics) {
    SceneDescription d =
        parse_world("Shape \"sphere\" \"float radius\" 2 \"float zmin\" 1 \"float zmax\" -5 "
                    "\"float phimax\" 180 \"float alpha\" 0.5 Shape \"sphere\" Shape \"disk\" Scale -1 "
                    "1 1 Shape \"sphere\" ReverseOrientation Shape \"sphere\" Identity Shape \"disk\"");
    EXPECT_EQ(sphere(d, 0).z_min, -2);
    EXPECT_EQ(sphere(d, 0).z_max, 1);
    EXPECT_FLOAT_EQ(sphere(d, 0).phi_max, 3.14159265f);
    EXPECT_EQ(d.scene.shapes[0].alpha.value, 0.5f);
    EXPECT_EQ(sphere(d, 1).radius, 1);
    EXPECT_EQ(sphere(d, 1).z_min, -1);
    const Disk& disk = std::get<Disk>(d.scene.quadrics[2]);
    EXPECT_EQ(disk.radius, 1);
    EXPECT_EQ(disk.inner_radius + disk.height, 0);
    bool flips[] = {false, false, false, true, false, true};
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(d.scene.shapes[i].flip_normal, flips[i]) << i;
    EXPECT_EQ(d.scene.world_shapes, (std::vector<Index>{0, 1, 2, 3, 4, 5}));
}

TEST(PbrtShapes, BilinearMeshes) {
    const std::string flat = " \"point3 P\" [0 0 0  1 0 0  0 1 0  1 1 0]",
                      bent = " \"point3 P\" [0 0 0  1 0 0  0 1 0  1 1 1]";
    const SceneDescription d =
        parse_world("Scale 2 2 -2 Shape \"bilinearmesh\"" + flat + "Shape \"bilinearmesh\"" + bent +
                    " \"point2 uv\" [0 0 2 0 0 2 2 2] \"integer indices\" [0 1 2 3 1 0 3 2 7]" +
                    "ReverseOrientation Shape \"bilinearmesh\" \"normal N\" [0 0 1 0 0 1 0 0 1 0 0 1]" +
                    flat + "Shape \"bilinearmesh\" \"point2 uv\" [0 0 2 0 0 2 2 3]" + flat +
                    "AreaLightSource \"diffuse\" \"float power\" 3 Shape \"bilinearmesh\"" + flat);
    ASSERT_EQ(d.scene.shapes.size(), 5u);
    ASSERT_EQ(d.scene.meshes.size(), 1u); // the parallelogram
    const TriangleMesh& mesh = d.scene.meshes[0];
    EXPECT_EQ(mesh.indices, (std::vector<Index>{0, 1, 3, 0, 3, 2}));
    EXPECT_EQ(mesh.uvs[3], (Point2f{1, 1}));
    ASSERT_EQ(d.scene.bilinear_meshes.size(), 4u);
    const BilinearMesh& patches = d.scene.bilinear_meshes[0];
    ASSERT_EQ(patches.patch_count(), 2u); // the ninth index is ignored with a warning
    expect_near(patches.positions[3], {2, 2, -2});
    EXPECT_EQ(patches.uvs[3], (Point2f{2, 2}));
    expect_near(normalize(d.scene.bilinear_meshes[1].normals[0]), {0, 0, 1}); // mirrored and reversed
    EXPECT_TRUE(d.scene.shapes[1].flip_normal);
    EXPECT_FALSE(d.scene.shapes[2].flip_normal);
    EXPECT_EQ(std::get<AreaLight>(d.scene.lights.at(0)).primitive_flux, 3);
    EXPECT_EQ(std::get<BilinearMeshIndex>(d.scene.shapes[4].geometry).index, 3u);
}

TEST(PbrtShapes, Curves) {
    const std::string points = " \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0 4 0 0]";
    const SceneDescription d = parse_world(
        "Scale 2 2 -2 Shape \"curve\" \"string basis\" \"bspline\" \"float width0\" 1 \"float width1\" 3" +
        points +
        "Shape \"curve\" \"integer degree\" 2 \"string type\" \"ribbon\" \"float width\" 0.5 "
        "\"normal N\" [0 0 2 0 3 0 0 0 2]" +
        points);
    ASSERT_EQ(d.scene.curves.size(), 2u);
    const Curves &spline = d.scene.curves[0], &ribbon = d.scene.curves[1];
    EXPECT_EQ(spline.kind, Curves::Kind::flat);
    ASSERT_EQ(spline.segment_count(), 2u);
    expect_near(spline.control_points[0][0], {2, 0, 0}); // (0 + 4 * 1 + 2) / 6, twice as large
    expect_near(spline.control_points[1][3], {6, 0, 0});
    EXPECT_FLOAT_EQ(spline.widths[0][0], 2);
    EXPECT_FLOAT_EQ(spline.widths[0][1], 4);
    EXPECT_FLOAT_EQ(spline.widths[1][1], 6);
    EXPECT_TRUE(spline.normals.empty());
    EXPECT_EQ(ribbon.kind, Curves::Kind::ribbon);
    ASSERT_EQ(ribbon.segment_count(), 2u);
    EXPECT_FLOAT_EQ(ribbon.widths[1][1], 1);
    expect_near(ribbon.normals[0][0], {0, 0, -1});
    expect_near(ribbon.normals[0][1], {0, 1, 0});
    EXPECT_TRUE(d.scene.shapes[0].flip_normal);
}

TEST(PbrtShapes, VertexTangents) {
    const std::string mesh = "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] ";
    Warnings warnings;
    const SceneDescription d =
        test::parse_world("Scale 1 2 3 Translate 4 5 6 " + mesh + "\"vector3 S\" [ 1 1 1  0 1 0  1 0 0 ] " +
                              mesh + "\"vector3 S\" [ 1 1 1 ] LightSource \"point\"",
                          &warnings);
    EXPECT_EQ(d.scene.meshes.at(0).tangents, (std::vector<Vec3f>{{1, 2, 3}, {0, 2, 0}, {1, 0, 0}}));
    EXPECT_TRUE(d.scene.meshes.at(1).tangents.empty());
    ASSERT_EQ(warnings.messages().size(), 1u);
    EXPECT_NE(warnings.messages()[0].find("parameter 'S' has 1 entries for 3 vertices; it is ignored"),
              std::string::npos);
}

// A head of hair in a file is a shape for each hair.
TEST(PbrtShapes, CurvesInARowAreOneShape) {
    const std::string curve = "Shape \"curve\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0] ";
    const auto shapes = [&](const std::string& between) {
        const SceneDescription d = parse_world(curve + between + curve);
        std::size_t segments = 0;
        for (const Curves& c : d.scene.curves) segments += c.segment_count();
        EXPECT_EQ(segments, 2u) << between;
        EXPECT_EQ(d.scene.curves.size(),
                  d.scene.shapes.size() - (between.find("sphere") != std::string::npos));
        return d.scene.curves.size();
    };
    EXPECT_EQ(shapes(""), 1u);
    EXPECT_EQ(shapes("Translate 1 0 0 "), 1u);
    EXPECT_EQ(shapes("AttributeBegin AttributeEnd "), 1u);
    EXPECT_EQ(shapes("Material \"diffuse\" "), 2u);
    EXPECT_EQ(shapes("ReverseOrientation "), 2u);
    EXPECT_EQ(shapes("Shape \"sphere\" "), 2u);
    EXPECT_EQ(shapes("Attribute \"shape\" \"float alpha\" 0.5 "), 2u);
    EXPECT_EQ(shapes("Attribute \"shape\" \"string type\" \"cylinder\" "), 2u);
    EXPECT_EQ(shapes("MakeNamedMedium \"m\" \"string type\" \"homogeneous\" MediumInterface \"m\" \"\" "),
              2u);
    const std::string object = "ObjectBegin \"o\" " + curve + "ObjectEnd ";
    EXPECT_EQ(parse_world(curve + object + curve).scene.curves.size(), 3u);
    EXPECT_EQ(shapes("ActiveTransform EndTime Translate 1 0 0 "), 2u);
}

TEST(PbrtShapes, Cylinders) {
    const SceneDescription d = parse_world(
        "Shape \"cylinder\" Scale 1 1 -2 Shape \"cylinder\" \"float radius\" 0.5 \"float zmin\" 3 "
        "\"float zmax\" 2 \"float phimax\" 90");
    const Cylinder& whole = std::get<Cylinder>(d.scene.quadrics[0]);
    EXPECT_EQ(whole.radius, 1);
    EXPECT_EQ(whole.z_min, -1);
    EXPECT_EQ(whole.z_max, 1);
    EXPECT_FLOAT_EQ(whole.phi_max, 6.2831853f);
    EXPECT_FALSE(d.scene.shapes[0].flip_normal);
    const Cylinder& part = std::get<Cylinder>(d.scene.quadrics[1]);
    EXPECT_EQ(part.radius, 0.5f);
    EXPECT_EQ(part.z_min, 2);
    EXPECT_EQ(part.z_max, 3);
    EXPECT_FLOAT_EQ(part.phi_max, 1.5707963f);
    expect_near(part.world_from_object.point(Vec3f(0, 0, 1)), {0, 0, -2});
    EXPECT_TRUE(d.scene.shapes[1].flip_normal);
}

TEST(PbrtShapes, MeshesGoToTheWorld) {
    SceneDescription d = parse_world(R"(
        ReverseOrientation
        Translate 0 0 1 Scale -2 1 1
        Shape "trianglemesh" "point3 P" [ 0 0 0  1 0 0  0 1 0  1 1 1 ] "integer indices" [ 0 1 2 2 1 3 ]
            "normal N" [ 1 0 0  0 0 1  0 0 1  0 0 1 ] "point2 uv" [ 0 0 1 0 0 1 1 1 ])");
    const TriangleMesh& mesh = d.scene.meshes.at(0);
    EXPECT_EQ(mesh.positions[1], Vec3f(-2, 0, 1));
    // Normals go by the inverse transpose, and are turned around by ReverseOrientation alone.
    expect_near(mesh.normals[0], {0.5f, 0, 0});
    expect_near(mesh.normals[1], {0, 0, -1});
    EXPECT_EQ(mesh.uvs[3], Vec2f(1, 1));
    EXPECT_EQ(mesh.indices, (std::vector<Index>{0, 1, 2, 2, 1, 3}));
    EXPECT_FALSE(d.scene.shapes[0].flip_normal); // both reversed and mirrored
    EXPECT_TRUE(std::holds_alternative<MeshIndex>(d.scene.shapes[0].geometry));
}

TEST(PbrtShapes, WhatDoesNotFitAMeshIsLeftOut) {
    Warnings warnings;
    SceneDescription d = parse_world(
        "LightSource \"point\" Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"point2 uv\" [0 0] "
        "\"normal N\" [0 0 1] \"integer indices\" [0 1 2 0]",
        &warnings);
    EXPECT_EQ(warnings.messages().size(), 3u);
    EXPECT_EQ(d.scene.meshes[0].indices.size(), 3u);
    EXPECT_TRUE(d.scene.meshes[0].normals.empty() && d.scene.meshes[0].uvs.empty());
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
