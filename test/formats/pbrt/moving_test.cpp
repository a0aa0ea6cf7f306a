// ActiveTransform: what moves, and what stays with a warning.
#include "test/formats/pbrt/parse.h"
#include "test/near.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/scene/scene_names.h"

namespace montelux {
namespace {

using test::parse;
using test::parse_world;

TEST(PbrtTransforms, EqualTransformsOfBothTimesDoNotMove) {
    SceneDescription d =
        parse_world("ActiveTransform StartTime Translate 1 0 0 ActiveTransform EndTime Translate 1 0 0 "
                    "ActiveTransform All Shape \"sphere\"");
    expect_near(std::get<Sphere>(d.scene.quadrics.at(0)).world_from_object.point(Vec3f()), {1, 0, 0});
    EXPECT_FALSE(moves(d.scene));
}

TEST(PbrtTransforms, ShapesInstancesAndCamerasMove) {
    const SceneDescription d = parse(R"(
        TransformTimes 1 3
        ActiveTransform EndTime Translate 0 0 -5 ActiveTransform All
        Camera "perspective" "float shutteropen" 1.5 "float shutterclose" 2
        WorldBegin
        Shape "sphere"
        ObjectBegin "ball" Shape "sphere" "float radius" 2 ObjectEnd
        Translate 1 0 0
        ActiveTransform EndTime Rotate 90 0 0 1 ActiveTransform All
        Shape "disk"
        Shape "trianglemesh" "point3 P" [ 0 0 0  1 0 0  0 1 0 ] "integer indices" [ 0 1 2 ]
        ObjectInstance "ball")");
    EXPECT_EQ(d.scene.camera.shutter_open, 0.25f);
    EXPECT_EQ(d.scene.camera.shutter_close, 0.5f);
    ASSERT_TRUE(d.scene.camera.motion.has_value());
    expect_near(d.scene.camera.motion->at(1).point(Vec3f()), {0, 0, 5});
    EXPECT_EQ(d.scene.world_shapes, (std::vector<Index>{0}));
    ASSERT_EQ(d.scene.instances.size(), 3u);
    ASSERT_EQ(d.scene.motions.size(), 3u);
    for (const Instance& instance : d.scene.instances) {
        ASSERT_NE(instance.motion, no_index);
        const Motion& motion = d.scene.motions[instance.motion];
        expect_near(motion.at(0).point(Vec3f(1, 0, 0)), {2, 0, 0});
        expect_near(motion.at(1).point(Vec3f(1, 0, 0)), {1, 1, 0});
    }
    EXPECT_TRUE(std::get<Sphere>(d.scene.quadrics[1]).world_from_object == Transform());
}

TEST(PbrtTransforms, WhatIsInTheSpaceOfAMovingCameraFollowsIt) {
    const SceneDescription d = parse(R"(
        Translate -1 0 0
        ActiveTransform EndTime Translate 0 0 -5 Rotate 90 0 1 0 ActiveTransform All
        Camera "perspective"
        WorldBegin
        CoordSysTransform "camera" Shape "sphere")");
    ASSERT_TRUE(d.scene.camera.motion.has_value());
    ASSERT_EQ(d.scene.instances.size(), 1u);
    ASSERT_NE(d.scene.instances[0].motion, no_index);
    const Motion& motion = d.scene.motions.at(d.scene.instances[0].motion);
    expect_near(motion.at(0).point(Vec3f(0, 0, 2)), {1, 0, 2});
    for (const float time : {0.f, 0.5f, 1.f})
        for (const Vec3f p : {Vec3f(), Vec3f(1, 0, 0), Vec3f(0, 1, 2)})
            expect_near(motion.at(time).point(p), d.scene.camera.motion->at(time).point(p));
}

TEST(PbrtTransforms, WhatCannotMoveStaysWithAWarning) {
    Warnings warnings;
    const SceneDescription d = parse(R"(WorldBegin
ActiveTransform EndTime Translate 1 0 0 ActiveTransform All
LightSource "point"
Texture "t" "float" "constant")",
                                     &warnings);
    EXPECT_EQ(warnings.messages().size(), 2u); // the texture is not used
    EXPECT_EQ(warnings.messages().at(0),
              "scene:4:1: a texture does not move: it stays where it is at the start");
}

// The transformations are those of the light at the start and the end, as of a still one.
TEST(PbrtTransforms, LightsMove) {
    Warnings warnings;
    const SceneDescription d = parse(R"(TransformTimes 2 3 WorldBegin
AttributeBegin
  Translate 1 2 3
  LightSource "point" "point3 from" [ 1 0 0 ] "string group" "lamps"
AttributeEnd
Translate 1 2 3
ActiveTransform EndTime Rotate 90 0 0 1 ActiveTransform All
LightSource "point" "point3 from" [ 1 0 0 ] "string group" "lamps"
LightSource "spot" "point3 from" [ 1 0 0 ] "point3 to" [ 1 2 0 ]
LightSource "distant" "point3 from" [ 3 0 0 ] "point3 to" [ 0 0 0 ]
LightSource "infinite" "rgb L" [ 1 1 1 ])",
                                     &warnings);
    EXPECT_TRUE(warnings.messages().empty());
    const Scene& s = d.scene;
    ASSERT_EQ(s.lights.size(), 5u);
    ASSERT_EQ(s.motions.size(), 3u);
    EXPECT_EQ(std::get<PointLight>(s.lights[0]).motion, no_index);
    expect_near(std::get<PointLight>(s.lights[0]).position, {2, 2, 3});
    const auto at = [&]<typename L>(const L& light, float time) {
        return light.moved(s.motions.at(light.motion).at(time));
    };
    const auto& point = std::get<PointLight>(s.lights[1]);
    EXPECT_EQ(at(point, 0).scale, std::get<PointLight>(s.lights[0]).scale);
    expect_near(at(point, 0).position, {2, 2, 3});
    expect_near(at(point, 1).position, {1, 3, 3});
    EXPECT_EQ(s.light_groups.at(1), "lamps");
    const auto& spot = std::get<SpotLight>(s.lights[2]);
    expect_near(at(spot, 0).axis, {0, 1, 0});
    expect_near(at(spot, 1).axis, {-1, 0, 0});
    expect_near(at(spot, 1).position, {1, 3, 3});
    const auto& distant = std::get<DistantLight>(s.lights[3]);
    expect_near(at(distant, 0).to_light, {1, 0, 0});
    expect_near(at(distant, 1).to_light, {0, 1, 0});
}

// pbrt's "sky" of this renderer: both of its lights.
TEST(PbrtTransforms, SkiesAndMapsTurn) {
    Warnings warnings;
    const SceneDescription d = parse(R"(WorldBegin
Rotate 30 1 0 0
ActiveTransform EndTime Rotate 40 0 1 0 ActiveTransform All
LightSource "sky")",
                                     &warnings);
    EXPECT_TRUE(warnings.messages().empty());
    const SceneDescription still = parse(R"(WorldBegin Rotate 30 1 0 0 Rotate 40 0 1 0 LightSource "sky")");
    ASSERT_EQ(d.scene.lights.size(), 2u);
    ASSERT_EQ(still.scene.lights.size(), 2u);
    const auto& sun = std::get<SunLight>(d.scene.lights[0]);
    const auto& sky = std::get<SkyLight>(d.scene.lights[1]);
    const SunLight sun_then = sun.moved(d.scene.motions.at(sun.motion).at(1));
    const SkyLight sky_then = sky.moved(d.scene.motions.at(sky.motion).at(1));
    expect_near(sun_then.disc.centre, std::get<SunLight>(still.scene.lights[0]).disc.centre);
    expect_near(sun_then.up, std::get<SunLight>(still.scene.lights[0]).up);
    EXPECT_EQ(sun_then.scale, std::get<SunLight>(still.scene.lights[0]).scale);
    for (const Vec3f v : {Vec3f(1, 0, 0), Vec3f(0, 1, 0)})
        expect_near(sky_then.world_from_light.vector(v),
                    std::get<SkyLight>(still.scene.lights[1]).world_from_light.vector(v));
}

TEST(PbrtTransforms, EmissiveShapesMove) {
    Warnings warnings;
    const SceneDescription d = parse(R"(WorldBegin
Scale -1 1 1
ActiveTransform EndTime Translate 1 0 0 ActiveTransform All
AreaLightSource "diffuse"
Shape "disk"
ReverseOrientation
Shape "trianglemesh" "point3 P" [ 0 0 0  1 0 0  0 1 0 ] "integer indices" [ 0 1 2 ]
Shape "disk")",
                                     &warnings);
    EXPECT_TRUE(warnings.messages().empty());
    const Scene& s = d.scene;
    EXPECT_TRUE(s.world_shapes.empty());
    ASSERT_EQ(s.instances.size(), 3u);
    ASSERT_EQ(s.lights.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(s.shapes[i].light, i);
        EXPECT_EQ(std::get<AreaLight>(s.lights[i]).shape, i);
        EXPECT_NE(s.instances[i].motion, no_index);
    }
    // The sides are those of still shapes: a mirrored disk shines from its other side.
    EXPECT_TRUE(s.shapes[0].flip_normal);
    EXPECT_TRUE(s.shapes[1].flip_normal);
    EXPECT_FALSE(s.shapes[2].flip_normal);
}

TEST(PbrtTransforms, ShapesInsideObjectsMove) {
    Warnings warnings;
    const SceneDescription d = parse(R"(WorldBegin
LightSource "infinite"
MakeNamedMedium "fog" "string type" "homogeneous"
MakeNamedMaterial "red" "string type" "diffuse" "rgb reflectance" [ 1 0 0 ]
Texture "holes" "float" "checkerboard"
ObjectBegin "cart"
  Shape "sphere"
  Translate 3 0 0
  ActiveTransform EndTime Rotate 90 0 0 1 ActiveTransform All
  NamedMaterial "red"
  MediumInterface "fog" ""
  Shape "sphere" "texture alpha" "holes" "float radius" 2
  ReverseOrientation
  Shape "trianglemesh" "point3 P" [ 0 0 0  1 0 0  0 1 0 ] "integer indices" [ 0 1 2 ]
  AreaLightSource "diffuse"
  Shape "disk"
ObjectEnd
Scale -1 1 1
ObjectInstance "cart"
ActiveTransform EndTime Translate 0 5 0 ActiveTransform All
ObjectInstance "cart")",
                                     &warnings);
    EXPECT_EQ(warnings.messages(),
              (std::vector<std::string>{"scene:16:3: area lights inside object definitions do not "
                                        "shine"}));
    const Scene& s = d.scene;
    EXPECT_TRUE(s.world_shapes.empty());
    ASSERT_EQ(s.objects.size(), 2u);
    EXPECT_EQ(s.objects[0].shapes, (std::vector<Index>{0}));
    EXPECT_EQ(s.objects[1].shapes, (std::vector<Index>{1, 2, 3}));
    EXPECT_EQ(instance_names(s), (std::vector<std::string>{"cart:0", "cart:0", "cart:1", "cart:1"}));
    EXPECT_EQ(s.shapes[1].media.inside, 0u);
    EXPECT_FALSE(s.shapes[1].alpha.is_constant());
    EXPECT_EQ(material_name(s, s.shapes[2].material), "red");
    EXPECT_FALSE(s.shapes[1].flip_normal);
    EXPECT_TRUE(s.shapes[2].flip_normal);
    ASSERT_EQ(s.motions.size(), 3u);
    const auto at = [&](std::size_t instance, float time) {
        return s.motions.at(s.instances[instance].motion).at(time).point(Vec3f(1, 0, 0));
    };
    expect_near(at(1, 0), {-4, 0, 0});
    expect_near(at(1, 1), {-3, 1, 0});
    expect_near(at(3, 0), {-4, 0, 0});
    expect_near(at(3, 1), {-3, 6, 0});
}

} // namespace
} // namespace montelux
