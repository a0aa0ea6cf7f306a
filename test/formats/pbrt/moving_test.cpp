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

TEST(PbrtTransforms, WhatCannotMoveStaysWithAWarning) {
    Warnings warnings;
    const SceneDescription d = parse(R"(WorldBegin
ActiveTransform EndTime Translate 1 0 0 ActiveTransform All
LightSource "point"
Texture "t" "float" "constant"
ObjectBegin "o"
Shape "sphere"
ObjectEnd
AttributeBegin
AreaLightSource "diffuse"
Shape "sphere"
AttributeEnd
Shape "sphere")",
                                     &warnings);
    const char* expected[] = {
        "scene:3:1: a light does not move: it stays where it is at the start",
        "scene:4:1: a texture does not move: it stays where it is at the start",
        "scene:10:1: a shape that emits light does not move: it stays where it is at the start",
    };
    for (const char* text : expected)
        EXPECT_TRUE(std::find(warnings.messages().begin(), warnings.messages().end(), text) !=
                    warnings.messages().end())
            << text;
    EXPECT_EQ(warnings.messages().size(), 4u); // the texture is not used
    EXPECT_EQ(d.scene.instances.size(), 1u);   // the last sphere
    EXPECT_EQ(d.scene.world_shapes.size(), 1u);
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
