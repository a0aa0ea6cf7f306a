// Meshes of glTF: values of vertices by all kinds of accessors, primitives, attributes, deformations.
#include "test/formats/gltf/model.h"
#include <algorithm>
#include <gtest/gtest.h>

namespace montelux {
namespace {

using test::load_model;
using test::Model;
using test::one_mesh;

std::string index_of(const std::string& name, int accessor) {
    return '"' + name + "\": " + std::to_string(accessor);
}

const TriangleMesh& mesh_of(const SceneDescription& d) { return d.scene.meshes.at(0); }

std::string attributes(const std::string& list) { return "\"attributes\": {" + list + "}"; }

TEST(GltfMeshes, TriangleWithoutIndices) {
    Model m;
    const int p = m.add_triangle();
    const SceneDescription d = load_model(m.text(one_mesh(attributes(index_of("POSITION", p)))));
    EXPECT_EQ(mesh_of(d).positions, (std::vector<Point3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh_of(d).indices, (std::vector<Index>{0, 1, 2}));
    EXPECT_EQ(d.scene.world_shapes.size(), 1u);
    EXPECT_FALSE(d.has_camera);
}

// One mesh by each of the types of components.
template <typename T>
std::vector<Point3f> positions_by(const std::vector<T>& values, const std::string& extra = "") {
    Model m;
    const int a = m.add(values, "VEC3", extra);
    const std::string text = m.text(one_mesh(attributes(index_of("POSITION", a))));
    return mesh_of(load_model(text)).positions;
}

TEST(GltfMeshes, ComponentTypes) {
    const std::vector<Point3f> expected{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    EXPECT_EQ(positions_by<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}), expected);
    EXPECT_EQ(positions_by<std::int8_t>({0, 0, 0, 1, 0, 0, 0, 1, 0}), expected);
    EXPECT_EQ(positions_by<std::uint16_t>({0, 0, 0, 1, 0, 0, 0, 1, 0}), expected);
    const std::string normalized = ", \"normalized\": true";
    EXPECT_EQ(positions_by<std::uint8_t>({0, 0, 0, 255, 0, 0, 0, 255, 0}, normalized), expected);
    EXPECT_EQ(positions_by<std::uint16_t>({0, 0, 0, 65535, 0, 0, 0, 65535, 0}, normalized), expected);
    EXPECT_EQ(positions_by<std::int16_t>({0, 0, 0, 32767, 0, 0, 0, 32767, 0}, normalized), expected);
    // The most negative value is -1 as well.
    EXPECT_EQ(positions_by<std::int8_t>({-128, 0, 0, 127, 0, 0, -127, 127, 0}, normalized),
              (std::vector<Point3f>{{-1, 0, 0}, {1, 0, 0}, {-1, 1, 0}}));
}

TEST(GltfMeshes, StridesAndOffsets) {
    Model m;
    m.bytes.resize(8); // before the view
    m.add<float>({0, 0, 0, 7, 1, 0, 0, 7, 0, 1, 0, 7}, "VEC4");
    const std::string text =
        R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 56, "uri": "data:;base64,)" +
        test::base64(m.bytes) +
        R"("}], "bufferViews": [{"buffer": 0, "byteOffset": 4, "byteLength": 52, "byteStride": 16}], "accessors": [
        {"bufferView": 0, "byteOffset": 4, "componentType": 5126, "count": 3, "type": "VEC3"}], )" +
        one_mesh(attributes(R"("POSITION": 0)")) + "}";
    EXPECT_EQ(mesh_of(load_model(text)).positions, (std::vector<Point3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(GltfMeshes, SparseAccessors) {
    Model m;
    m.add_triangle();
    m.add<std::uint8_t>({1}, "SCALAR");
    m.add<float>({2, 3, 4}, "VEC3");
    const std::string sparse =
        R"(, "sparse": {"count": 1, "indices": {"bufferView": 1, "componentType": 5121},
        "values": {"bufferView": 2}})";
    for (const bool with_view : {true, false}) {
        Model changed = m;
        changed.accessors += std::string(", {") + (with_view ? R"("bufferView": 0, )" : "") +
                             R"("componentType": 5126, "count": 3, "type": "VEC3")" + sparse + "}";
        const std::string primitive = attributes(R"("POSITION": 3)");
        const Point3f last = with_view ? Point3f{0, 1, 0} : Point3f{0, 0, 0};
        EXPECT_EQ(mesh_of(load_model(changed.text(one_mesh(primitive)))).positions,
                  (std::vector<Point3f>{{0, 0, 0}, {2, 3, 4}, last}));
    }
}

// The byte stride applies to the base view only; sparse values are tightly packed.
TEST(GltfMeshes, SparseAccessorsOfInterleavedViews) {
    Model m;
    m.add<float>({0, 0, 0, 7, 1, 0, 0, 7, 0, 1, 0, 7}, "VEC4");
    m.add<std::uint8_t>({0, 2}, "SCALAR");
    m.add<float>({2, 3, 4, 5, 6, 8}, "VEC3");
    m.add<float>({9, 9, 9, 9}, "VEC4"); // behind the sparse values
    m.views += R"(, {"buffer": 0, "byteLength": 48, "byteStride": 16})";
    m.accessors +=
        R"(, {"bufferView": 4, "componentType": 5126, "count": 3, "type": "VEC3", "sparse": {"count": 2,
        "indices": {"bufferView": 1, "componentType": 5121}, "values": {"bufferView": 2}}})";
    EXPECT_EQ(mesh_of(load_model(m.text(one_mesh(attributes(R"("POSITION": 4)"))))).positions,
              (std::vector<Point3f>{{2, 3, 4}, {1, 0, 0}, {5, 6, 8}}));
}

// Of four vertices two are sparse, and a primitive uses three.
TEST(GltfMeshes, SparseAccessorsOfSharedVertices) {
    Model m;
    m.add<float>({0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0}, "VEC3");
    m.add<std::uint8_t>({1, 3}, "SCALAR");
    m.add<float>({10, 0, 0, 30, 0, 0}, "VEC3");
    const int indices = m.add<std::uint16_t>({3, 2, 0}, "SCALAR");
    m.accessors +=
        R"(, {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "sparse": {"count": 2,
        "indices": {"bufferView": 1, "componentType": 5121}, "values": {"bufferView": 2}}})";
    const SceneDescription d =
        load_model(m.text(one_mesh(attributes(R"("POSITION": 4)") + ", " + index_of("indices", indices))));
    EXPECT_EQ(mesh_of(d).positions, (std::vector<Point3f>{{0, 0, 0}, {2, 0, 0}, {30, 0, 0}}));
    EXPECT_EQ(mesh_of(d).indices, (std::vector<Index>{2, 1, 0}));
}

TEST(GltfMeshes, IndicesAndModes) {
    const auto triangles = [](int mode, const std::vector<std::uint16_t>& indices) {
        Model m;
        std::vector<float> points;
        for (int i = 0; i < 5; ++i) points.insert(points.end(), {float(i), float(i * i), 0});
        const int p = m.add(points, "VEC3"), i = m.add(indices, "SCALAR");
        return mesh_of(load_model(m.text(one_mesh(attributes(index_of("POSITION", p)) + ", " +
                                                  index_of("indices", i) + ", " + index_of("mode", mode)))))
            .indices;
    };
    using Indices = std::vector<Index>;
    EXPECT_EQ(triangles(4, {0, 1, 2, 2, 3, 4}), (Indices{0, 1, 2, 2, 3, 4}));
    // Fronts stay fronts.
    EXPECT_EQ(triangles(5, {0, 1, 2, 3, 4}), (Indices{0, 1, 2, 1, 3, 2, 2, 3, 4}));
    EXPECT_EQ(triangles(6, {0, 1, 2, 3, 4}), (Indices{1, 2, 0, 2, 3, 0, 3, 4, 0}));
}

TEST(GltfMeshes, TypesOfIndices) {
    const auto by = []<typename T>(T) {
        Model m;
        const int p = m.add_triangle(), i = m.add<T>({2, 0, 1}, "SCALAR");
        return mesh_of(load_model(m.text(
                           one_mesh(attributes(index_of("POSITION", p)) + ", " + index_of("indices", i)))))
            .indices;
    };
    const std::vector<Index> expected{2, 0, 1};
    EXPECT_EQ(by(std::uint8_t{}), expected);
    EXPECT_EQ(by(std::uint16_t{}), expected);
    EXPECT_EQ(by(std::uint32_t{}), expected);
}

// A primitive that uses few of many shared vertices takes these alone.
TEST(GltfMeshes, SharedVertices) {
    Model m;
    std::vector<float> points;
    for (int i = 0; i < 100; ++i) points.insert(points.end(), {float(i), 0, float(i % 7)});
    const int p = m.add(points, "VEC3"), i = m.add<std::uint16_t>({90, 5, 40}, "SCALAR");
    const SceneDescription d =
        load_model(m.text(one_mesh(attributes(index_of("POSITION", p)) + ", " + index_of("indices", i))));
    EXPECT_EQ(mesh_of(d).positions, (std::vector<Point3f>{{5, 0, 5}, {40, 0, 5}, {90, 0, 6}}));
    EXPECT_EQ(mesh_of(d).indices, (std::vector<Index>{2, 0, 1}));
}

TEST(GltfMeshes, PointsAndLinesAreToldOf) {
    for (const int mode : {0, 1, 2, 3}) {
        Model m;
        Warnings warnings;
        const int p = m.add_triangle();
        const SceneDescription d = load_model(
            m.text(one_mesh(attributes(index_of("POSITION", p)) + ", " + index_of("mode", mode))), &warnings);
        EXPECT_TRUE(d.scene.shapes.empty());
        const std::string expected =
            "folder/model.gltf: /meshes/0/primitives/0: points and lines are not rendered";
        EXPECT_EQ(std::ranges::count(warnings.messages(), expected), 1) << mode;
    }
}

TEST(GltfMeshes, Attributes) {
    Model m;
    const int p = m.add_triangle(), n = m.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3"),
              t = m.add<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1}, "VEC4"),
              uv = m.add<std::uint8_t>({0, 0, 255, 0, 0, 51}, "VEC2", ", \"normalized\": true"),
              c = m.add<std::uint16_t>({65535, 0, 0, 65535, 0, 65535, 0, 0, 0, 0, 65535, 13107}, "VEC4",
                                       ", \"normalized\": true");
    const std::string list = index_of("POSITION", p) + ", " + index_of("NORMAL", n) + ", " +
                             index_of("TANGENT", t) + ", " + index_of("TEXCOORD_0", uv) + ", " +
                             index_of("COLOR_0", c);
    const SceneDescription d = load_model(m.text(one_mesh(attributes(list))));
    const TriangleMesh& mesh = mesh_of(d);
    EXPECT_EQ(mesh.normals, std::vector<Normal3f>(3, Normal3f(0, 0, 1)));
    EXPECT_EQ(mesh.tangents, std::vector<Vec3f>(3, Vec3f(1, 0, 0)));
    // v grows upwards.
    EXPECT_EQ(mesh.uvs, (std::vector<Point2f>{{0, 1}, {1, 1}, {0, 0.8f}}));
    EXPECT_EQ(mesh.colors, (std::vector<Vec3f>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
    EXPECT_EQ(mesh.opacities, (std::vector<float>{1, 0, 0.2f}));
}

TEST(GltfMeshes, WithoutNormalsAMeshIsFlatAndHasNoTangents) {
    Model m;
    const int p = m.add_triangle(), t = m.add<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1}, "VEC4");
    const SceneDescription d =
        load_model(m.text(one_mesh(attributes(index_of("POSITION", p) + ", " + index_of("TANGENT", t)))));
    EXPECT_TRUE(mesh_of(d).normals.empty());
    EXPECT_TRUE(mesh_of(d).tangents.empty());
}

TEST(GltfMeshes, MorphTargets) {
    Model m;
    const int p = m.add_triangle(), n = m.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3"),
              dp = m.add<float>({0, 0, 4, 0, 0, 0, 0, 0, 0}, "VEC3"),
              dn = m.add<float>({0, 2, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
    const std::string primitive = attributes(index_of("POSITION", p) + ", " + index_of("NORMAL", n)) +
                                  ", \"targets\": [{" + index_of("POSITION", dp) + "}, {" +
                                  index_of("NORMAL", dn) + "}]";
    const auto at = [&](const std::string& in_mesh, const std::string& in_node) {
        return mesh_of(load_model(m.text(R"("meshes": [{"primitives": [{)" + primitive + "}]" + in_mesh +
                                         R"(}], "nodes": [{"mesh": 0)" + in_node + "}]")));
    };
    EXPECT_EQ(at("", "").positions[0], Point3f(0, 0, 0));
    EXPECT_EQ(at(R"(, "weights": [0.5, 0])", "").positions[0], Point3f(0, 0, 2));
    const TriangleMesh mesh = at(R"(, "weights": [0.5, 0])", R"(, "weights": [0.25, 0.5])");
    EXPECT_EQ(mesh.positions[0], Point3f(0, 0, 1));
    EXPECT_EQ(mesh.normals[0], Normal3f(0, 1, 1));
}

// Joint 0 stands still, joint 1 is lifted by 3; its bind position was 1.
TEST(GltfMeshes, Skins) {
    Model m;
    const int p = m.add_triangle(),
              joints = m.add<std::uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, "VEC4"),
              weights = m.add<float>({1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0}, "VEC4"),
              bind = m.add<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0,  1,
                                   1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -1, 1},
                                  "MAT4");
    const std::string text = m.text(
        R"("meshes": [{"primitives": [{)" +
        attributes(index_of("POSITION", p) + ", " + index_of("JOINTS_0", joints) + ", " +
                   index_of("WEIGHTS_0", weights)) +
        R"(}]}], "skins": [{"joints": [1, 2], "inverseBindMatrices": )" + std::to_string(bind) +
        R"(}], "nodes": [{"mesh": 0, "skin": 0, "translation": [9, 9, 9]}, {}, {"translation": [0, 0, 4]}],
        "scenes": [{"nodes": [0, 1, 2]}])");
    EXPECT_EQ(mesh_of(load_model(text)).positions,
              (std::vector<Point3f>{{0, 0, 0}, {1, 0, 3}, {0, 1, 1.5f}}));
}

} // namespace
} // namespace montelux
