// Nodes of glTF: transformations, instances, scenes, animations.
#include "test/formats/gltf/model.h"
#include <gtest/gtest.h>

#include "montelux/scene/shape/surface_point.h"

namespace montelux {
namespace {

using test::load_model;
using test::Model;

// A triangle for mesh 0, and `members` of the root.
std::string with_triangle(const std::string& members) {
    Model m;
    m.add_triangle();
    return m.text(R"("meshes": [{"name": "leaf", "primitives": [{"attributes": {"POSITION": 0}}]}], )" +
                  members);
}

Point3f first_vertex(const SceneDescription& d) { return d.scene.meshes.at(0).positions.at(0); }
Point3f second_vertex(const SceneDescription& d) { return d.scene.meshes.at(0).positions.at(1); }

void expect_near(Point3f a, Point3f b) { EXPECT_LT(length(a - b), 1e-5f) << a.x << ' ' << a.y << ' ' << a.z; }

TEST(GltfNodes, TransformationsMultiply) {
    const SceneDescription d = load_model(with_triangle(
        R"("nodes": [{"children": [1], "matrix": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 1, 2, 3, 1]},
                     {"mesh": 0, "translation": [10, 0, 0], "rotation": [0, 0, 0.70710678, 0.70710678],
                      "scale": [3, 1, 1]}])"));
    expect_near(first_vertex(d), {21, 2, 3});
    expect_near(second_vertex(d), {21, 8, 3}); // (1 0 0) scaled, turned to y, and scaled again
    EXPECT_EQ(d.scene.shape_names.at(0), "leaf");
}

// A mirrored mesh keeps its front: counter-clockwise in the file.
TEST(GltfNodes, MirroredMeshesKeepTheirFronts) {
    const auto front = [](const std::string& scale) {
        const SceneDescription d =
            load_model(with_triangle(R"("nodes": [{"mesh": 0, "scale": )" + scale + "}]"));
        const Ray ray{.o = {0, 0, 5}, .d = {0, 0, -1}};
        Hit hit;
        hit.t = 5;
        hit.b1 = hit.b2 = 0.25f;
        hit.shape = hit.primitive = 0;
        return surface_point(SceneView(d.scene), ray, hit, false).ng.z;
    };
    EXPECT_EQ(front("[1, 1, 1]"), 1);
    EXPECT_EQ(front("[-1, 1, 1]"), 1);
    EXPECT_EQ(front("[1, 1, -1]"), -1);
}

// KHR_node_visibility hides what is below a node, too, but no camera.
TEST(GltfNodes, HiddenNodesHaveNeitherMeshesNorLights) {
    const auto load = [](const std::string& visible) {
        return load_model(with_triangle(
            R"("extensions": {"KHR_lights_punctual": {"lights": [{"type": "point"}]}},
               "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}],
               "nodes": [{"mesh": 0, "children": [1], "extensions": {"KHR_node_visibility": {)" +
            visible + R"(}}},
                         {"mesh": 0, "camera": 0, "children": [2], "extensions": {"KHR_node_visibility": {"visible": true}}},
                         {"extensions": {"KHR_lights_punctual": {"light": 0}}}, {"mesh": 0, "translation": [5, 0, 0]}])"));
    };
    for (const std::string visible : {"", R"("visible": true)"}) {
        const SceneDescription d = load(visible);
        EXPECT_EQ(d.scene.instances.size(), 3u);
        EXPECT_EQ(d.scene.lights.size(), 1u);
    }
    const SceneDescription d = load(R"("visible": false)");
    EXPECT_EQ(d.scene.world_shapes.size(), 1u);
    expect_near(first_vertex(d), {5, 0, 0});
    EXPECT_TRUE(d.scene.lights.empty());
    EXPECT_TRUE(d.has_camera);
}

TEST(GltfNodes, MeshesUsedTwiceAreInstances) {
    const SceneDescription d = load_model(with_triangle(
        R"("nodes": [{"mesh": 0, "translation": [1, 0, 0]}, {"mesh": 0, "translation": [0, 2, 0]}])"));
    ASSERT_EQ(d.scene.meshes.size(), 1u);
    EXPECT_EQ(first_vertex(d), Point3f(0, 0, 0));
    EXPECT_TRUE(d.scene.world_shapes.empty());
    ASSERT_EQ(d.scene.instances.size(), 2u);
    EXPECT_EQ(d.scene.instances[0].world_from_object.point(Point3f()), Point3f(1, 0, 0));
    EXPECT_EQ(d.scene.instances[1].world_from_object.point(Point3f()), Point3f(0, 2, 0));
}

// Shapes in objects would be dark.
TEST(GltfNodes, EmissiveMeshesUsedTwiceShineTwice) {
    Model m;
    m.add_triangle();
    const SceneDescription d = load_model(m.text(
        R"("materials": [{"emissiveFactor": [1, 1, 1]}],
           "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}, {"attributes": {"POSITION": 0}}]}],
           "nodes": [{"mesh": 0}, {"mesh": 0, "translation": [0, 0, 5]}])"));
    EXPECT_EQ(d.scene.lights.size(), 2u);
    EXPECT_EQ(d.scene.world_shapes.size(), 2u);
    EXPECT_EQ(d.scene.instances.size(), 2u);
}

TEST(GltfNodes, GpuInstancing) {
    Model m;
    m.add_triangle();
    m.add<float>({1, 2, 3, 4, 5, 6}, "VEC3");
    m.add<std::int8_t>({0, 0, 127, 0, 0, 0, 0, 127}, "VEC4", ", \"normalized\": true");
    const SceneDescription d = load_model(m.text(
        R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
           "nodes": [{"mesh": 0, "translation": [100, 0, 0],
                      "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1, "ROTATION": 2}}}}])"));
    ASSERT_EQ(d.scene.instances.size(), 2u);
    expect_near(d.scene.instances[0].world_from_object.point(Point3f(1, 0, 0)), {100, 2, 3});
    expect_near(d.scene.instances[1].world_from_object.point(Point3f(1, 0, 0)), {105, 5, 6});
}

TEST(GltfNodes, TheDefaultSceneIsShown) {
    const std::string nodes = R"("nodes": [{"mesh": 0}, {"mesh": 0, "translation": [0, 0, 7]}])";
    Warnings warnings;
    EXPECT_EQ(first_vertex(load_model(with_triangle(nodes + R"(, "scenes": [{"nodes": [1]}])"))),
              Point3f(0, 0, 7));
    EXPECT_EQ(
        first_vertex(load_model(
            with_triangle(nodes + R"(, "scene": 1, "scenes": [{"nodes": [1]}, {"nodes": [0]}])"), &warnings)),
        Point3f(0, 0, 0));
    EXPECT_EQ(warnings.messages().at(0), "folder/model.gltf: /scenes/1: is shown; the file has 2 scenes");
}

TEST(GltfNodes, ScaleZeroHides) {
    Warnings warnings;
    const SceneDescription d =
        load_model(with_triangle(R"("nodes": [{"mesh": 0, "scale": [0, 0, 0]}])"), &warnings);
    EXPECT_TRUE(d.scene.shapes.empty());
    EXPECT_EQ(warnings.messages().at(0),
              "folder/model.gltf: /nodes/0: its transformation has no inverse: its mesh is not shown");
}

// Keys at 1 s and 3 s; of a channel with its interpolation and numbers.
SceneDescription animated(const std::string& interpolation, const std::string& path,
                          const std::vector<float>& output, std::optional<double> time) {
    Model m;
    m.add_triangle();
    m.add<float>({1, 3}, "SCALAR");
    m.add(output, path == "rotation" ? "VEC4" : "VEC3");
    return load_model(m.text(R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": [{"mesh": 0, "translation": [0, 0, 1]}],
        "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": ")" +
                             path + R"("}}], "samplers": [{"input": 1, "output": 2, "interpolation": ")" +
                             interpolation + R"("}]}])"),
                      nullptr, {.time = time});
}

TEST(GltfNodes, AnimatedLinearly) {
    const std::vector<float> path{0, 0, 0, 10, 0, 0};
    expect_near(first_vertex(animated("LINEAR", "translation", path, std::nullopt)), {0, 0, 1});
    expect_near(first_vertex(animated("LINEAR", "translation", path, 0)), {0, 0, 0});
    expect_near(first_vertex(animated("LINEAR", "translation", path, 1.5)), {2.5f, 0, 0});
    expect_near(first_vertex(animated("LINEAR", "translation", path, 99)), {10, 0, 0});
    expect_near(first_vertex(animated("STEP", "translation", path, 2.9)), {0, 0, 0});
    expect_near(first_vertex(animated("STEP", "translation", path, 3)), {10, 0, 0});
    // Half-way of half a turn around z.
    expect_near(second_vertex(animated("LINEAR", "rotation", {0, 0, 0, 1, 0, 0, 1, 0}, 2)), {0, 1, 1});
}

// p(t) = (2 t^3 - 3 t^2 + 1) p0 + L (t^3 - 2 t^2 + t) m0 + (3 t^2 - 2 t^3) p1 + L (t^3 - t^2) m1 at t = 1/2, L = 2.
TEST(GltfNodes, AnimatedByCubicSplines) {
    const std::vector<float> keys{9, 9, 9, 0, 0, 0, 4, 0, 0, 0, 8, 0, 10, 0, 0, 9, 9, 9};
    expect_near(first_vertex(animated("CUBICSPLINE", "translation", keys, 2)), {5 + 1, -2, 0});
    expect_near(first_vertex(animated("CUBICSPLINE", "translation", keys, 0)), {0, 0, 0});
}

TEST(GltfNodes, TheEndOfAnimationsIsTold) {
    EXPECT_EQ(animated("LINEAR", "translation", {0, 0, 0, 1, 0, 0}, 0).animation_end, 3);
    EXPECT_EQ(animated("LINEAR", "translation", {0, 0, 0, 1, 0, 0}, std::nullopt).animation_end, 0);
    EXPECT_EQ(load_model(with_triangle(R"("nodes": [{"mesh": 0}])"), nullptr, {.time = 1}).animation_end, 0);
}

TEST(GltfNodes, AnimatedWeights) {
    Model m;
    m.add_triangle();
    m.add<float>({0, 1}, "SCALAR");
    m.add<float>({0, 8}, "SCALAR");
    m.add<float>({0, 0, 1, 0, 0, 0, 0, 0, 0}, "VEC3");
    const std::string text = m.text(R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0},
        "targets": [{"POSITION": 3}]}]}], "nodes": [{"mesh": 0}], "animations": [{"channels": [{"sampler": 0,
        "target": {"node": 0, "path": "weights"}}], "samplers": [{"input": 1, "output": 2}]}])");
    expect_near(first_vertex(load_model(text, nullptr, {.time = 0.5})), {0, 0, 4});
    expect_near(first_vertex(load_model(text)), {0, 0, 0});
}

} // namespace
} // namespace montelux
