// Motion blur of glTF animations: what moves, deforms or stands still while the shutter is open.
#include "test/formats/gltf/model.h"
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/scene/light/light_tables.h"

namespace montelux {
namespace {

using test::load_model;
using test::Model;

// Accessors: 0 a triangle, 1 keys at 0 s and 2 s, 2 from the origin to (10 0 0), 3 half a turn around z, 4 from scale 1
// to 0, 5 weights from 0 to 1, 6 the change of a morph target, 7 joints, 8 their weights, 9 to scale -1.
Model parts() {
    Model m;
    m.add_triangle();
    m.add<float>({0, 2}, "SCALAR");
    m.add<float>({0, 0, 0, 10, 0, 0}, "VEC3");
    m.add<float>({0, 0, 0, 1, 0, 0, 1, 0}, "VEC4");
    m.add<float>({1, 1, 1, 0, 0, 0}, "VEC3");
    m.add<float>({0, 1}, "SCALAR");
    m.add<float>({0, 0, 8, 0, 0, 8, 0, 0, 8}, "VEC3");
    m.add<std::uint8_t>({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
    m.add<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    m.add<float>({1, 1, 1, -1, 1, 1}, "VEC3");
    return m;
}
std::string animation(int node, const std::string& path, int output) {
    return R"("animations": [{"channels": [{"sampler": 0, "target": {"node": )" + std::to_string(node) +
           R"(, "path": ")" + path + R"("}}], "samplers": [{"input": 1, "output": )" +
           std::to_string(output) + "}]}]";
}
const std::string leaf = R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], )";

// The shutter opens at 0.5 s, and closes at 1 s.
SceneDescription blurred(const std::string& members, Warnings* warnings = nullptr, double shutter = 0.5) {
    return load_model(parts().text(members), warnings, {.time = 0.5, .shutter = shutter});
}
void expect_near(Point3f a, Point3f b) { EXPECT_LT(length(a - b), 1e-5f) << a.x << ' ' << a.y << ' ' << a.z; }

TEST(GltfMotion, NodesMove) {
    const SceneDescription d =
        blurred(leaf + R"("nodes": [{"children": [1]}, {"mesh": 0, "translation": [0, 0, 1]}], )" +
                animation(0, "translation", 2));
    ASSERT_EQ(d.scene.motions.size(), 1u);
    const Motion& motion = d.scene.motions[d.scene.instances.at(0).motion];
    expect_near(motion.at(0).point(Point3f()), {2.5f, 0, 1});
    expect_near(motion.at(0.5f).point(Point3f()), {3.75f, 0, 1});
    expect_near(motion.at(1).point(Point3f()), {5, 0, 1});
    EXPECT_EQ(d.scene.camera.shutter_open, 0);
    EXPECT_EQ(d.scene.camera.shutter_close, 1);
}

// Along the arc, not its chord.
TEST(GltfMotion, NodesTurn) {
    const SceneDescription d = blurred(leaf + R"("nodes": [{"mesh": 0}], )" + animation(0, "rotation", 3));
    const Point3f middle = d.scene.motions.at(0).at(0.5f).point(Point3f(1, 0, 0));
    const float angle = 3.14159265f * 0.375f; // of 0.75 s
    EXPECT_LT(length(middle - Point3f(std::cos(angle), std::sin(angle), 0)), 2e-4f);
}

TEST(GltfMotion, StillsHaveNone) {
    const std::string scene = leaf + R"("nodes": [{"mesh": 0}], )" + animation(0, "translation", 2);
    EXPECT_FALSE(moves(blurred(scene, nullptr, 0).scene));
    // After the last key, and nodes without animation.
    EXPECT_FALSE(moves(load_model(parts().text(scene), nullptr, {.time = 2, .shutter = 1}).scene));
    const SceneDescription d =
        blurred(leaf + R"("nodes": [{"mesh": 0}, {}], )" + animation(1, "translation", 2));
    EXPECT_FALSE(moves(d.scene));
    EXPECT_EQ(d.scene.world_shapes.size(), 1u);
}

TEST(GltfMotion, InstancesMoveEachByItself) {
    const SceneDescription d =
        blurred(leaf + R"("nodes": [{"mesh": 0}, {"mesh": 0, "translation": [0, 3, 0]}], )" +
                animation(0, "translation", 2));
    ASSERT_EQ(d.scene.instances.size(), 2u);
    EXPECT_EQ(d.scene.meshes.size(), 1u);
    EXPECT_NE(d.scene.instances[0].motion, no_index);
    EXPECT_EQ(d.scene.instances[1].motion, no_index);
    EXPECT_LT(length(bounds_of(d.scene).upper - Vec3d(6, 4, 0)), 1e-5);
}

TEST(GltfMotion, EmittersMove) {
    const SceneDescription d = blurred(R"("materials": [{"emissiveFactor": [1, 1, 1]}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}], "nodes": [{"mesh": 0}], )" +
                                       animation(0, "translation", 2));
    EXPECT_EQ(d.scene.lights.size(), 1u);
    EXPECT_EQ(d.scene.motions.size(), 1u);
    EXPECT_TRUE(d.scene.objects.at(0).shines);
}

TEST(GltfMotion, MorphedMeshesDeform) {
    const SceneDescription d = blurred(
        R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "targets": [{"POSITION": 6}]}]}],
           "nodes": [{"mesh": 0, "translation": [0, 0, 100]}], )" +
        animation(0, "weights", 5));
    const TriangleMesh& mesh = d.scene.meshes.at(0);
    ASSERT_TRUE(mesh.deforms());
    expect_near(mesh.position(0, 0), {0, 0, 102});
    expect_near(mesh.position(0, 1), {0, 0, 104});
    EXPECT_TRUE(d.scene.motions.empty());
}

TEST(GltfMotion, SkinnedMeshesDeform) {
    const SceneDescription d = blurred(
        R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 6, "TANGENT": 8, "JOINTS_0": 7,
           "WEIGHTS_0": 8}}]}],
           "nodes": [{"mesh": 0, "skin": 0, "translation": [0, 0, 100]}, {}], "skins": [{"joints": [1]}], )" +
        animation(1, "rotation", 3));
    const TriangleMesh& mesh = d.scene.meshes.at(0);
    ASSERT_TRUE(mesh.deforms());
    expect_near(mesh.positions[1], {std::sqrt(0.5f), std::sqrt(0.5f), 0});
    expect_near(mesh.end_positions[1], {0, 1, 0});
    EXPECT_EQ(mesh.end_normals.size(), 3u);
    EXPECT_TRUE(mesh.tangents.empty());
}

TEST(GltfMotion, CamerasMove) {
    const SceneDescription d =
        blurred(R"("cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}],
           "nodes": [{"camera": 0}], )" +
                animation(0, "translation", 2));
    ASSERT_TRUE(d.scene.camera.motion.has_value());
    expect_near(d.scene.camera.motion->at(0).point(Point3f()), {2.5f, 0, 0});
    expect_near(d.scene.camera.motion->at(1).point(Point3f(0, 0, 1)), {5, 0, -1});
    EXPECT_EQ(d.scene.camera.world_from_camera, d.scene.camera.motion->start());
}

TEST(GltfMotion, LightsMove) {
    const auto light = [](const std::string& type, const std::string& path, int output) {
        return blurred(
            R"("extensions": {"KHR_lights_punctual": {"lights": [{"type": ")" + type +
            R"("}]}}, "nodes": [{"scale": [2, 2, 2], "extensions": {"KHR_lights_punctual": {"light": 0}}}], )" +
            animation(0, path, output));
    };
    const auto at = [](const SceneDescription& d, float time) { return d.scene.motions.at(0).at(time); };
    const SceneDescription point = light("point", "translation", 2);
    EXPECT_LT(
        length(std::get<PointLight>(point.scene.lights.at(0)).moved(at(point, 1)).position - Vec3f(5, 0, 0)),
        1e-5f);
    EXPECT_TRUE(light("point", "rotation", 3).scene.motions.empty());
    const SceneDescription spot = light("spot", "translation", 2);
    const SpotLight moved = std::get<SpotLight>(spot.scene.lights.at(0)).moved(at(spot, 0));
    EXPECT_LT(length(moved.position - Vec3f(2.5f, 0, 0)), 1e-5f);
    EXPECT_LT(length(moved.axis - Vec3f(0, 0, -1)), 1e-5f);
    const SceneDescription sun = light("directional", "rotation", 3);
    EXPECT_LT(
        length(std::get<DistantLight>(sun.scene.lights.at(0)).moved(at(sun, 0)).to_light - Vec3f(0, 0, 1)),
        1e-5f);
}

// No path leads through them: the picture shows the scene when the shutter opens.
TEST(GltfMotion, FlatAndMirroredEndsStandStill) {
    Warnings warnings;
    const std::string node = R"("nodes": [{"mesh": 0}], )";
    const auto load = [&](int output) {
        return load_model(parts().text(leaf + node + animation(0, "scale", output)), &warnings,
                          {.time = 0.5, .shutter = 1.5});
    };
    SceneDescription d = load(4);
    EXPECT_FALSE(moves(d.scene));
    expect_near(d.scene.meshes.at(0).positions.at(1), {0.75f, 0, 0});
    EXPECT_EQ(warnings.messages().at(0),
              "folder/model.gltf: /nodes/0: is flat at a moment while the shutter is open, or mirrored: it "
              "stands still meanwhile");
    d = load(9);
    EXPECT_FALSE(moves(d.scene));
}

} // namespace
} // namespace montelux
