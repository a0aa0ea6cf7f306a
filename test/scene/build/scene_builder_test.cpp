// SceneBuilder: the scene it makes, the errors it gives, and their places.
#include "test/scene/build/located_error.h"
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "montelux/mc/math/constants.h"
#include "montelux/scene/build/scene_builder.h"

namespace montelux {
namespace {

using testing::located_error;

class Recorded final : public BuildMessages {
  public:
    std::string describe(SourceLocation at) const override { return "line " + std::to_string(at.line); }
    void warn(SourceLocation at, std::string_view sentence) override {
        warnings.push_back(describe(at) + ": " + std::string(sentence));
    }
    void warn_once(std::string_view key, SourceLocation at, std::string_view sentence) override {
        if (keys.emplace(key).second) warn(at, sentence);
    }
    std::vector<std::string> warnings;
    std::set<std::string> keys;
};

SourceLocation line(std::uint32_t number) { return {0, number, 1}; }

TriangleMesh two_triangles() {
    return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {}, {}, {0, 1, 2, 2, 1, 3}};
}

class SceneBuilding : public ::testing::Test {
  protected:
    std::string shape_error(Geometry geometry) {
        return located_error([&] { builder_.add_shape(std::move(geometry), {}, line(7)); });
    }
    // Of a scene with an instance, nine times as large, of an object with that shape.
    std::string instance_error(Geometry geometry) {
        builder_.begin_object("o");
        builder_.add_shape(std::move(geometry), {});
        builder_.end_object();
        builder_.add_instance("o", Transform::scale({9, 9, 9}), line(5));
        return located_error([&] { builder_.finish(line(9)); });
    }

    Scene scene_;
    Recorded messages_;
    SceneBuilder builder_{scene_, messages_};
};

TEST_F(SceneBuilding, GeometryIsChecked) {
    const float infinity = std::numeric_limits<float>::infinity();
    auto changed = [](auto change) {
        TriangleMesh mesh = two_triangles();
        change(mesh);
        return mesh;
    };
    EXPECT_EQ(shape_error(two_triangles()), "");
    EXPECT_EQ(shape_error(changed([](TriangleMesh& m) { m.indices[4] = 4; })),
              "line 7: triangle 1 refers to vertex 4; the mesh has 4 vertices");
    EXPECT_EQ(shape_error(changed([](TriangleMesh& m) { m.indices[0] = no_index; })),
              "line 7: triangle 0 refers to vertex 4294967295; the mesh has 4 vertices");
    EXPECT_EQ(shape_error(changed([](TriangleMesh& m) { m.indices.pop_back(); })),
              "line 7: the mesh has 5 indices; expected three per triangle");
    EXPECT_EQ(shape_error(changed([](TriangleMesh& m) { m.normals.resize(3); })),
              "line 7: the mesh has 3 normals for 4 vertices; expected one per vertex");
    EXPECT_EQ(shape_error(changed([](TriangleMesh& m) { m.uvs.resize(5); })),
              "line 7: the mesh has 5 texture coordinates for 4 vertices; expected one per vertex");
    EXPECT_EQ(shape_error(changed([&](TriangleMesh& m) { m.positions[3].y = infinity; })),
              "line 7: vertex 3 lies at infinity in world space");
    EXPECT_EQ(shape_error(changed([&](TriangleMesh& m) {
                  m.normals.resize(4);
                  m.normals[1].x = std::nanf("");
              })),
              "line 7: a vertex normal is not finite in world space");
    auto deforming = [&](auto change) {
        return changed([&](TriangleMesh& m) {
            m.end_positions = m.positions;
            m.normals.assign(4, {0, 0, 1});
            m.end_normals = m.normals;
            change(m);
        });
    };
    EXPECT_EQ(shape_error(deforming([](TriangleMesh& m) { m.end_positions.pop_back(); })),
              "line 7: the mesh has 3 positions at the end for 4 vertices; expected one per vertex");
    EXPECT_EQ(shape_error(deforming([](TriangleMesh& m) { m.end_normals.emplace_back(); })),
              "line 7: the mesh has 5 normals at the end for 4 vertices; expected one per vertex");
    EXPECT_EQ(shape_error(deforming([](TriangleMesh& m) { m.end_normals.clear(); })),
              "line 7: the mesh has normals at the start, but none at the end");
    EXPECT_EQ(shape_error(deforming([](TriangleMesh& m) { m.normals.clear(); })),
              "line 7: the mesh has normals at the end, but none at the start");
    EXPECT_EQ(shape_error(deforming([](TriangleMesh& m) { m.end_positions.clear(); })),
              "line 7: the mesh has normals at the end, but no positions");
    EXPECT_EQ(shape_error(deforming([](TriangleMesh& m) {
                  m.tangents.assign(4, {1, 0, 0});
              })),
              "line 7: a mesh that deforms has no vertex tangents");
    EXPECT_EQ(shape_error(deforming([&](TriangleMesh& m) { m.end_positions[2].x = -infinity; })),
              "line 7: vertex 2 lies at infinity in world space at the end");
    EXPECT_EQ(shape_error(deforming([&](TriangleMesh& m) { m.end_normals[0].x = std::nanf(""); })),
              "line 7: a vertex normal is not finite in world space at the end");
    EXPECT_TRUE(scene_.lights.empty());
    EXPECT_EQ(shape_error(Sphere{.world_from_object = Transform::translate({1e39, 0, 0})}),
              "line 7: the shape reaches to infinity in world space");
    // Nothing of what was refused is left behind.
    EXPECT_EQ(scene_.shapes.size(), 1u);
    EXPECT_EQ(scene_.meshes.size(), 1u);
    EXPECT_EQ(scene_.world_shapes, (std::vector<Index>{0}));
}

TEST_F(SceneBuilding, TransformsMoveNormalsAsWell) {
    TriangleMesh mesh = two_triangles();
    mesh.normals.assign(4, {0, 0, 1});
    transform_mesh(mesh, Transform::translate({1, 2, 3}) * Transform::scale({1, 1, 2}), true);
    EXPECT_EQ(mesh.positions[3], (Point3f{2, 3, 3}));
    EXPECT_EQ(mesh.normals[0], (Normal3f{0, 0, -0.5f}));
    EXPECT_FALSE(mesh.deforms());
    mesh.end_positions = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {1, 1, 1}};
    mesh.end_normals.assign(4, {0, 0, 1});
    transform_mesh(mesh, Transform::scale({1, 1, 2}), true);
    EXPECT_EQ(mesh.end_positions[3], (Point3f{1, 1, 2}));
    EXPECT_EQ(mesh.end_normals[0], (Normal3f{0, 0, -0.5f}));
}

// Lambertian flux is pi times area times luminance.
TEST_F(SceneBuilding, AreaLightsHaveTheirPower) {
    const Emission emission{1.0f, 2, false, 12}, both{1.0f, 2, true, 12};
    builder_.add_shape(Sphere{.world_from_object = {}}, {.alpha = {1}, .emission = &emission});
    builder_.add_shape(Disk{.radius = 2, .inner_radius = 1, .world_from_object = {}},
                       {.alpha = {1}, .emission = &both});
    builder_.add_shape(two_triangles(), {.alpha = {1}, .emission = &emission});
    ASSERT_EQ(scene_.lights.size(), 3u);
    const auto& sphere = std::get<AreaLight>(scene_.lights[0]);
    const auto& ring = std::get<AreaLight>(scene_.lights[1]);
    const auto& mesh = std::get<AreaLight>(scene_.lights[2]);
    EXPECT_NEAR(sphere.scale, 2 * 12 / (pi * 4 * pi), 1e-5);
    EXPECT_NEAR(ring.scale, 2 * 12 / (2 * pi * 3 * pi), 1e-5);
    EXPECT_EQ(mesh.scale, 2);
    EXPECT_EQ(mesh.primitive_flux, 12);
    for (Index i = 0; i < 3; ++i) {
        EXPECT_EQ(scene_.shapes[i].light, i);
        EXPECT_EQ(std::get<AreaLight>(scene_.lights[i]).shape, i);
    }
    TriangleMesh nothing;
    builder_.add_shape(nothing, {.alpha = {1}, .emission = &emission});
    EXPECT_EQ(scene_.lights.size(), 3u); // no triangle, no light
}

TEST_F(SceneBuilding, PhotometricUnits) {
    const RgbIlluminantSpectrum white(RgbColorSpace::srgb(), {1, 1, 1}),
        red(RgbColorSpace::srgb(), {5, 0, 0});
    EXPECT_EQ(photometric_scale(white), photometric_scale(red)); // RGB keeps its meaning
    EXPECT_NEAR(photometric_scale(Spectrum(2.0f)) * to_photometric(Spectrum(2.0f)), 1, 1e-6);
    EXPECT_EQ(photometric_scale(Spectrum()), 0);
    EXPECT_THROW(photometric_scale(Spectrum(-1.0f)), Error);
    EXPECT_NEAR(point_intensity(100), 100 / (4 * pi), 1e-5);
    // A spot light with a sharp edge fills its cone.
    EXPECT_NEAR(spot_intensity(100, 0.5, 0.5), 100 / pi, 1e-4);
    EXPECT_NEAR(sky_luminance(100), 100 / pi, 1e-5);
}

TEST_F(SceneBuilding, ObjectsAreKnownByName) {
    const Emission emission{1.0f};
    const Transform moved = Transform::translate({1, 0, 0});
    builder_.add_instance("tree", moved, line(2)); // which comes later
    for (const char* name : {"stone", "tree"}) {
        builder_.begin_object(name, line(3));
        builder_.add_shape(two_triangles(), {.alpha = {1}, .emission = &emission}, line(4));
        builder_.end_object();
    }
    builder_.add_shape(two_triangles(), {});
    builder_.add_instance("stone", {}, line(5));
    EXPECT_EQ(located_error([&] { builder_.begin_object("tree", line(6)); }),
              "line 6: object 'tree' is defined twice");
    EXPECT_EQ(messages_.warnings,
              (std::vector<std::string>{"line 4: area lights inside object definitions do not shine"}));
    EXPECT_TRUE(scene_.lights.empty());
    for (Shape& s : scene_.shapes) s.material = 0;
    scene_.materials.resize(1);
    builder_.finish(line(9));
    EXPECT_EQ(scene_.world_shapes, (std::vector<Index>{2}));
    ASSERT_EQ(scene_.instances.size(), 2u);
    EXPECT_EQ(scene_.instances[0].object, 1u);
    EXPECT_EQ(scene_.instances[0].world_from_object, moved);
    EXPECT_EQ(scene_.instances[1].object, 0u);
    EXPECT_EQ(messages_.warnings.back(), "line 9: the scene has no light; its picture is black");

    EXPECT_EQ(located_error([&] {
                  builder_.add_instance("trees", {}, line(8));
                  builder_.finish(line(9));
              }),
              "line 8: object 'trees' is not defined (did you mean 'tree'?)");
    EXPECT_EQ(located_error([&] {
                  builder_.add_instance("tree", Transform::scale({1e39, 1, 1}), line(8));
              }),
              "line 8: the instance's transformation is beyond what single-precision numbers hold");
}

TEST_F(SceneBuilding, InstancesAtInfinityAreRefused) {
    EXPECT_EQ(instance_error(Disk{.radius = 3e38f, .world_from_object = {}}),
              "line 5: the instance reaches to infinity in world space");
}

// Where a mesh ends counts as well.
TEST_F(SceneBuilding, InstancesThatDeformToInfinityAreRefused) {
    TriangleMesh mesh = two_triangles();
    mesh.end_positions = mesh.positions;
    mesh.end_positions[0].x = 3e38f;
    EXPECT_EQ(instance_error(mesh), "line 5: the instance reaches to infinity in world space");
}

TEST_F(SceneBuilding, ShapesWithoutMaterialAreRefused) {
    builder_.add_shape(two_triangles(), {});
    EXPECT_EQ(located_error([&] { builder_.finish(line(9)); }), "line 9: shape 0 has no material");
    scene_.shapes[0].material = 0;
    scene_.materials.resize(1);
    scene_.shapes[0].alpha.texture = 3;
    EXPECT_EQ(located_error([&] { builder_.finish(line(9)); }),
              "line 9: the alpha of shape 0 has no texture");
}

TEST_F(SceneBuilding, ImagesAreMadeFit) {
    Image picture(2, 1, {"R", "G", "B"});
    picture.f32()[1] = std::nanf("");
    picture.f32()[5] = -std::numeric_limits<float>::infinity();
    picture.f32()[0] = 3;
    EXPECT_EQ(builder_.add_image(picture, "wood.exr", line(2)), 0u);
    EXPECT_EQ(scene_.images[0].f32()[0], 3);
    EXPECT_EQ(scene_.images[0].f32()[1], 0);
    EXPECT_EQ(scene_.images[0].f32()[5], 0);
    EXPECT_EQ(messages_.warnings, (std::vector<std::string>{
                                      "line 2: wood.exr has 2 values that are not finite; they count as 0"}));
    EXPECT_EQ(located_error([&] {
                  builder_.add_image(Image(2, 2, {"X", "Y", "Z"}), "xyz.exr", line(3));
              }),
              "line 3: xyz.exr has neither channels R, G and B nor Y alone");
}

TEST_F(SceneBuilding, ImagesOfHalfsAreMadeFit) {
    Image picture(2, 1, {"R", "G", "B"}, PixelFormat::f16);
    const std::array<std::uint16_t, 6> halfs{0x7c00, 0xfc00, 0x7e01, 0x7bff, 0xfbff, 0x0001};
    for (std::size_t i = 0; i < halfs.size(); ++i) picture.u16()[i] = halfs[i];
    builder_.add_image(picture, "wood.exr", line(2));
    // Infinities and a NaN, then the largest numbers and the smallest.
    const std::array<std::uint16_t, 6> expected{0, 0, 0, 0x7bff, 0xfbff, 0x0001};
    for (std::size_t i = 0; i < halfs.size(); ++i) EXPECT_EQ(scene_.images[0].u16()[i], expected[i]) << i;
    EXPECT_EQ(messages_.warnings, (std::vector<std::string>{
                                      "line 2: wood.exr has 3 values that are not finite; they count as 0"}));
}

TEST_F(SceneBuilding, EnvironmentsAreMadeFit) {
    Image grey(4, 4, {"Y"});
    grey.f32()[3] = 2;
    grey.f32()[4] = -1;
    EXPECT_EQ(builder_.add_environment(grey, "sky.exr", line(2)), 0u);
    const Image& map = scene_.environments[0];
    EXPECT_EQ(map.channel_names(), (std::vector<std::string>{"R", "G", "B"}));
    for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(map.value(3, 0, c), 2);
        EXPECT_EQ(map.value(0, 1, c), 0);
    }
    EXPECT_EQ(messages_.warnings,
              (std::vector<std::string>{"line 2: sky.exr has negative pixels; they count as 0"}));
    builder_.add_environment(Image(8, 4, {"R", "G", "B"}), "night.exr", line(3));
    EXPECT_EQ(messages_.warnings.back(), "line 3: night.exr is black; the light gives nothing");
    EXPECT_NE(located_error([&] {
                  builder_.add_environment(Image(3, 4, {"Y"}), "odd.exr", line(4));
              }).find("line 4: odd.exr has 3 x 4 pixels; an environment map must be square"),
              std::string::npos);
    grey.f32()[0] = std::nanf("");
    EXPECT_EQ(located_error([&] { builder_.add_environment(grey, "bad.exr", line(5)); }),
              "line 5: bad.exr has a pixel that is not finite");
}

TEST_F(SceneBuilding, SkiesBringTheirSun) {
    SceneBuilder::SkyLights sky;
    builder_.add_sky(sky);
    ASSERT_EQ(scene_.lights.size(), 2u);
    EXPECT_TRUE(std::holds_alternative<SunLight>(scene_.lights[0]));
    EXPECT_TRUE(std::holds_alternative<SkyLight>(scene_.lights[1]));
    sky.sun = false;
    builder_.add_sky(sky);
    sky.sun = true;
    sky.settings.elevation = -3;
    builder_.add_sky(sky);
    EXPECT_EQ(scene_.lights.size(), 4u); // below the horizon there is none
    EXPECT_EQ(scene_.skies.size(), 3u);
    EXPECT_EQ(std::get<SkyLight>(scene_.lights[3]).sky, 2u);
    sky.settings.elevation = 100;
    EXPECT_EQ(located_error([&] { builder_.add_sky(sky, line(3)); }).substr(0, 7), "line 3:");
}

TEST_F(SceneBuilding, SkiesGiveTheRequestedIlluminance) {
    for (const bool sun : {false, true}) {
        Scene scene;
        SceneBuilder(scene, messages_)
            .add_sky({.settings = {}, .sun = sun, .illuminance = 1000, .world_from_light = {}});
        const auto& sky = std::get<SkyLight>(scene.lights.back());
        const SpectrumTable dome = scene.skies[0].sky_irradiance(), disc = scene.skies[0].sun_irradiance();
        const double total =
            integrate_luminance([&](float lambda) { return dome(lambda) + (sun ? disc(lambda) : 0.0f); });
        EXPECT_NEAR(sky.scale * total, 1000, 0.01) << sun;
    }
}

TEST(NameTable, ReferencesAreResolvedOnce) {
    NameTable table("thing");
    const Recorded messages;
    const Index a = table.refer("a"), b = table.refer("b");
    EXPECT_EQ(table.refer("a"), a);
    EXPECT_NE(a, b);
    table.declare("b", 5, {}, messages);
    EXPECT_EQ(table.resolve(b, {}, messages), 5u);
    EXPECT_THROW(table.resolve(a, {}, messages, "this line's "), LocatedError);
}

TEST(SceneBuilder, SkiesAreFew) {
    Scene scene;
    scene.skies.assign(16, SkyModel());
    CallMessages messages("a test");
    try {
        SceneBuilder(scene, messages).add_sky({});
        ADD_FAILURE();
    } catch (const Error& e) {
        EXPECT_STREQ(e.what(), "a test: more than 16 skies: each takes a second to compute");
    }
}

} // namespace
} // namespace montelux
