// Compressed glTF files: EXT_meshopt_compression, KHR_draco_mesh_compression and EXT_texture_webp, whole and damaged.
#include "test/formats/gltf/model.h"
#include <array>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#ifdef MONTELUX_MESHOPT
#include <meshoptimizer.h>
#endif
#ifdef MONTELUX_DRACO
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#endif
#ifdef MONTELUX_WEBP
#include <webp/encode.h>
#endif

#include "montelux/formats/gltf/coverage.h"
#include "montelux/formats/gltf/draco.h"
#include "montelux/formats/gltf/meshopt.h"
#include "montelux/image/image_read.h"

namespace montelux {
namespace {

using test::load_model;
using test::Model;
using test::model_error;
using Bytes = std::vector<std::uint8_t>;

// A required extension is shown, or refused with the library that is missing.
TEST(GltfCompressed, MissingLibrariesAreNamed) {
    const auto error = [](const std::string& extension) {
        return model_error(R"({"asset": {"version": "2.0"}, "extensionsRequired": [")" + extension + "\"]}");
    };
    const auto refused = [](const std::string& extension, const std::string& library) {
        return "/extensionsRequired/0: the scene requires the extension '" + extension +
               "', which is not supported: Montelux was built without " + library;
    };
    EXPECT_EQ(error("EXT_meshopt_compression"),
              gltf::reads_meshopt() ? "" : refused("EXT_meshopt_compression", "libmeshoptimizer"));
    EXPECT_EQ(error("KHR_draco_mesh_compression"),
              gltf::reads_draco() ? "" : refused("KHR_draco_mesh_compression", "libdraco"));
    const std::string webp = error("EXT_texture_webp");
    EXPECT_EQ(webp.substr(0, webp.find(';')), reads_webp() ? "" : refused("EXT_texture_webp", "libwebp"));
    EXPECT_NE(error("KHR_texture_basisu"), "");
}

// Loads damaged variants of the data at `bytes[from...]`: every one is shown or refused.
template <typename TextOf>
void expect_refused_or_read(Bytes bytes, std::size_t from, const TextOf& text_of) {
    int refused = 0;
    for (std::size_t i = from; i < bytes.size(); ++i)
        for (const std::uint8_t change : {0x01, 0x80, 0xff}) {
            bytes[i] ^= change;
            refused += model_error(text_of(bytes)).empty() ? 0 : 1;
            bytes[i] ^= change;
        }
    EXPECT_GT(refused, 0);
}

#ifdef MONTELUX_MESHOPT

// A grid of 9 vertices and 8 triangles.
const std::vector<float> grid_positions = [] {
    std::vector<float> p;
    for (int i = 0; i < 9; ++i)
        p.insert(p.end(), {static_cast<float>(i % 3), static_cast<float>(i / 3), 0.25f});
    return p;
}();
const std::vector<std::uint16_t> grid_indices = [] {
    std::vector<std::uint16_t> indices;
    for (const int corner : {0, 1, 3, 4})
        for (const int v : {corner, corner + 1, corner + 3, corner + 1, corner + 4, corner + 3})
            indices.push_back(static_cast<std::uint16_t>(v));
    return indices;
}();

Bytes packed_attributes(const void* values, std::size_t count, std::size_t stride) {
    Bytes bytes(meshopt_encodeVertexBufferBound(count, stride));
    bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), values, count, stride));
    return bytes;
}
Bytes packed_triangles(const std::vector<std::uint16_t>& indices) {
    Bytes bytes(meshopt_encodeIndexBufferBound(indices.size(), 9));
    bytes.resize(meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), indices.data(), indices.size()));
    return bytes;
}
Bytes packed_sequence(const std::vector<std::uint16_t>& indices) {
    Bytes bytes(meshopt_encodeIndexSequenceBound(indices.size(), 9));
    bytes.resize(meshopt_encodeIndexSequence(bytes.data(), bytes.size(), indices.data(), indices.size()));
    return bytes;
}

// A view of compressed bytes, and its accessor.
int add_packed(Model& m, const Bytes& packed, std::size_t count, std::size_t stride, const std::string& mode,
               const std::string& accessor) {
    m.bytes.resize((m.bytes.size() + 3) / 4 * 4);
    const std::size_t offset = m.bytes.size();
    m.bytes.insert(m.bytes.end(), packed.begin(), packed.end());
    const std::string comma = m.count == 0 ? "" : ", ";
    m.views += comma + R"({"buffer": 1, "byteLength": )" + std::to_string(count * stride) +
               R"(, "extensions": {"EXT_meshopt_compression": {"buffer": 0, "byteOffset": )" +
               std::to_string(offset) + R"(, "byteLength": )" + std::to_string(packed.size()) +
               R"(, "byteStride": )" + std::to_string(stride) + R"(, "count": )" + std::to_string(count) +
               R"(, "mode": )" + mode + "}}" +
               (mode.starts_with("\"ATTRIBUTES") ? R"(, "byteStride": )" + std::to_string(stride) : "") + "}";
    m.accessors += comma + R"({"bufferView": )" + std::to_string(m.count) + R"(, "count": )" +
                   std::to_string(count) + ", " + accessor + "}";
    return m.count++;
}
constexpr const char* floats_3 = R"("componentType": 5126, "type": "VEC3")";
constexpr const char* shorts = R"("componentType": 5123, "type": "SCALAR")";

Model packed_grid(bool sequence) {
    Model m;
    add_packed(m, packed_attributes(grid_positions.data(), 9, 12), 9, 12, "\"ATTRIBUTES\"", floats_3);
    if (sequence)
        add_packed(m, packed_sequence(grid_indices), 24, 2, "\"INDICES\"", shorts);
    else
        add_packed(m, packed_triangles(grid_indices), 24, 2, "\"TRIANGLES\"", shorts);
    return m;
}
const std::string one_grid = test::one_mesh(R"("attributes": {"POSITION": 0}, "indices": 1)");

TEST(GltfMeshopt, AttributesAndIndices) {
    for (const bool sequence : {false, true}) {
        const SceneDescription d = load_model(packed_grid(sequence).text(one_grid));
        const TriangleMesh& mesh = d.scene.meshes.at(0);
        ASSERT_EQ(mesh.positions.size(), 9u);
        EXPECT_EQ(mesh.positions[7], Point3f(1, 2, 0.25f));
        ASSERT_EQ(mesh.indices.size(), 24u);
        // The corners of a triangle may begin at another one.
        const std::array<Index, 3> last{mesh.indices[21], mesh.indices[22], mesh.indices[23]};
        EXPECT_EQ(last[0] + last[1] + last[2], 5u + 8u + 7u);
    }
}

TEST(GltfMeshopt, Filters) {
    Model m;
    m.add_triangle();
    const std::vector<float> normals{0, 0, 1, 0, 0.6f, 0, 0.8f, 0, -0.36f, 0.48f, 0.8f, 0};
    std::vector<std::int8_t> octahedral(12);
    meshopt_encodeFilterOct(octahedral.data(), 3, 4, 8, normals.data());
    add_packed(m, packed_attributes(octahedral.data(), 3, 4), 3, 4, R"("ATTRIBUTES", "filter": "OCTAHEDRAL")",
               R"("componentType": 5120, "normalized": true, "type": "VEC3")");
    const std::vector<float> uvs{0.25f, 0.5f, 100, -3, 0, 1};
    std::vector<std::uint32_t> exponents(6);
    meshopt_encodeFilterExp(exponents.data(), 3, 8, 15, uvs.data());
    add_packed(m, packed_attributes(exponents.data(), 3, 8), 3, 8, R"("ATTRIBUTES", "filter": "EXPONENTIAL")",
               R"("componentType": 5126, "type": "VEC2")");
    const std::vector<float> turns{0, 0, 0.70710678f, 0.70710678f, 0, 0, 0, 1, 1, 0, 0, 0};
    std::vector<std::int16_t> quaternions(12);
    meshopt_encodeFilterQuat(quaternions.data(), 3, 8, 16, turns.data());
    add_packed(m, packed_attributes(quaternions.data(), 3, 8), 3, 8,
               R"("ATTRIBUTES", "filter": "QUATERNION")",
               R"("componentType": 5122, "normalized": true, "type": "VEC4")");
    const SceneDescription d = load_model(m.text(
        R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}}]}],
           "nodes": [{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"ROTATION": 3}}}}])"));
    const TriangleMesh& mesh = d.scene.meshes.at(0);
    EXPECT_LT(length(mesh.normals.at(1) - Vec3f(0.6f, 0, 0.8f)), 0.02f);
    EXPECT_LT(length(mesh.normals.at(2) - Vec3f(-0.36f, 0.48f, 0.8f)), 0.02f);
    EXPECT_LT(length(mesh.uvs.at(1) - Point2f(100, 4)), 0.02f);
    EXPECT_LT(length(d.scene.instances.at(0).world_from_object.point(Point3f(1, 0, 0)) - Point3f(0, 1, 0)),
              1e-3f);
}

TEST(GltfMeshopt, MistakesAreSentences) {
    const std::string good = packed_grid(false).text(one_grid);
    const auto changed = [&](const std::string& from, const std::string& to) {
        std::string text = good;
        text.replace(text.find(from), from.size(), to);
        return model_error(text);
    };
    const std::string at = "/bufferViews/0/extensions/EXT_meshopt_compression";
    EXPECT_EQ(changed("ATTRIBUTES", "ATTRIBUTE"),
              at + ": unknown name 'ATTRIBUTE' (did you mean 'ATTRIBUTES'?)");
    EXPECT_EQ(changed(R"("byteStride": 12)", R"("byteStride": 10)"),
              at + "/byteStride: a stride of 10 bytes; expected a multiple of 4 up to 256");
    EXPECT_EQ(changed(R"("count": 9)", R"("count": 10)"),
              at + "/count: 10 elements of 12 bytes; the buffer view has 108 bytes");
    EXPECT_EQ(changed(R"("count": 9)", R"("count": 9007199254740992)"),
              at + "/count: 9007199254740992 elements of 12 bytes; the buffer view has 108 bytes");
    EXPECT_EQ(changed(R"("count": 24)", R"("count": 23)"),
              "/bufferViews/1/extensions/EXT_meshopt_compression/count: 23 is no multiple of 3");
    EXPECT_EQ(changed(R"("mode": "ATTRIBUTES")", R"("mode": "ATTRIBUTES", "filter": "OCTAHEDRAL")"),
              at + "/filter: the filter OCTAHEDRAL is not for such elements");
    EXPECT_EQ(changed("EXT_meshopt", "KHR_meshopt"),
              "/bufferViews/0: is compressed by KHR_meshopt_compression, which is not read");
    // 2^40 bytes of a short file.
    std::string bomb = good;
    constexpr std::string_view length = R"("byteLength": 108)"; // of the buffer and of the view
    for (std::size_t at_length; (at_length = bomb.find(length)) != std::string::npos;)
        bomb.replace(at_length, length.size(), R"("byteLength": 1099511627776)");
    bomb.replace(bomb.find(R"("byteStride": 12, "count": 9)"), 28,
                 R"("byteStride": 256, "count": 4294967296)");
    EXPECT_NE(model_error(bomb).find("describes more than 64 times the bytes that it has"), std::string::npos)
        << model_error(bomb);
}

TEST(GltfMeshopt, DamagedDataAreRefused) {
    Model m = packed_grid(false);
    expect_refused_or_read(m.bytes, 0, [&](const Bytes& bytes) {
        m.bytes = bytes;
        return m.text(one_grid);
    });
}

#endif
#ifdef MONTELUX_DRACO

// A triangle and a half-turned one beside it, with texture coordinates and joints.
Bytes packed_mesh(bool edgebreaker) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(2);
    const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32),
              uv = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32),
              joint = builder.AddAttribute(draco::GeometryAttribute::GENERIC, 4, draco::DT_UINT8);
    const float p[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.5f}},
                st[4][2] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
    const std::uint8_t joints[4][4] = {{0, 1, 2, 3}, {0, 1, 2, 3}, {0, 1, 2, 3}, {0, 1, 2, 3}};
    const int corners[2][3] = {{0, 1, 2}, {1, 3, 2}};
    for (int f = 0; f < 2; ++f) {
        const auto set = [&](int attribute, const auto& values) {
            builder.SetAttributeValuesForFace(attribute, draco::FaceIndex(static_cast<std::uint32_t>(f)),
                                              values[corners[f][0]], values[corners[f][1]],
                                              values[corners[f][2]]);
        };
        set(position, p);
        set(uv, st);
        set(joint, joints);
    }
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::Encoder encoder;
    encoder.SetEncodingMethod(edgebreaker ? draco::MESH_EDGEBREAKER_ENCODING
                                          : draco::MESH_SEQUENTIAL_ENCODING);
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeMeshToBuffer(*mesh, &buffer).ok()) return {};
    return {buffer.data(), buffer.data() + buffer.size()};
}

std::string draco_model(const Bytes& packed,
                        const std::string& attributes = R"("POSITION": 0, "TEXCOORD_0": 1)",
                        std::size_t vertices = 4, std::size_t corners = 6) {
    const std::string count = std::to_string(vertices);
    return R"({"asset": {"version": "2.0"}, "extensionsRequired": ["KHR_draco_mesh_compression"],
        "buffers": [{"byteLength": )" +
           std::to_string(packed.size()) + R"(, "uri": "data:application/octet-stream;base64,)" +
           test::base64(packed) + R"("}], "bufferViews": [{"buffer": 0, "byteLength": )" +
           std::to_string(packed.size()) + R"(}], "accessors": [{"componentType": 5126, "count": )" + count +
           R"(, "type": "VEC3"},
            {"componentType": 5126, "count": )" +
           count + R"(, "type": "VEC2"},
            {"componentType": 5123, "count": )" +
           std::to_string(corners) + R"(, "type": "SCALAR"},
            {"componentType": 5123, "count": )" +
           count + R"(, "type": "VEC4"}],
        "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1,
            "JOINTS_0": 3}, "indices": 2, "extensions": {"KHR_draco_mesh_compression": {"bufferView": 0,
            "attributes": {)" +
           attributes + "}}}}]}]}";
}

TEST(GltfDraco, Meshes) {
    for (const bool edgebreaker : {false, true}) {
        const SceneDescription d = load_model(draco_model(packed_mesh(edgebreaker)));
        const TriangleMesh& mesh = d.scene.meshes.at(0);
        ASSERT_EQ(mesh.positions.size(), 4u);
        ASSERT_EQ(mesh.indices.size(), 6u);
        float area = 0;
        for (std::size_t t = 0; t < 6; t += 3) {
            const auto p = [&](std::size_t k) { return mesh.positions[mesh.indices[t + k]]; };
            area += cross(p(1) - p(0), p(2) - p(0)).z / 2;
        }
        EXPECT_FLOAT_EQ(area, 1);           // both face +z
        for (std::size_t v = 0; v < 4; ++v) // the file's v grows downwards
            EXPECT_LT(length(mesh.uvs.at(v) - Point2f(mesh.positions[v].x, 1 - mesh.positions[v].y)), 1e-3f);
    }
}

TEST(GltfDraco, AttributesAreConverted) {
    const Bytes packed = packed_mesh(true);
    Warnings warnings;
    const std::string text = draco_model(packed);
    const gltf::Accessor as{.bytes = {},
                            .count = 4,
                            .component = gltf::Accessor::Component::u16,
                            .type = "VEC4",
                            .components = 4,
                            .element_bytes = 8,
                            .source = [] {
                                static const nlohmann::json none;
                                static Warnings ignored;
                                static gltf::Diagnostics diagnostics("a", ignored);
                                return gltf::Value(none, "", diagnostics);
                            }()};
    const gltf::DracoMesh mesh(packed, 4, 2, as.source);
    const Bytes joints = mesh.attribute(2, as, as.source);
    const std::uint16_t expected[4] = {0, 1, 2, 3};
    ASSERT_EQ(joints.size(), 32u);
    for (std::size_t v = 0; v < 4; ++v) EXPECT_EQ(std::memcmp(joints.data() + 8 * v, expected, 8), 0);
}

TEST(GltfDraco, MistakesAreSentences) {
    const std::string at = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
    const Bytes packed = packed_mesh(true);
    EXPECT_EQ(model_error(draco_model(packed, R"("POSITION": 9)")),
              at + "/attributes/POSITION: the Draco data have no attribute 9");
    EXPECT_EQ(
        model_error(draco_model(packed, R"("POSITION": 1)")),
        at + "/attributes/POSITION: the attribute of the Draco data has 2 components; its accessor has 3");
    EXPECT_EQ(model_error(draco_model(packed, R"("POSITION": 0)", 5)),
              at + ": the Draco data have 4 vertices; the accessors 5");
    EXPECT_EQ(model_error(draco_model(packed, R"("POSITION": 0)", 4, 9)),
              at + ": the Draco data have 2 triangles; the accessors 3");
    EXPECT_EQ(model_error(draco_model({1, 2, 3, 4})), at + ": the data are not of Draco");
    Bytes other = packed;
    other[6] = 1;
    EXPECT_EQ(model_error(draco_model(other)), at + ": a Draco bitstream of version 2.1; expected 2.2");
    other = packed;
    other[10] |= 0x80;
    EXPECT_EQ(model_error(draco_model(other)), at + ": Draco data with metadata, which are not read");
    EXPECT_EQ(model_error(draco_model(Bytes(packed.begin(), packed.begin() + 12))),
              at + ": the Draco data end too early");
    EXPECT_EQ(model_error(draco_model(Bytes(packed.begin(), packed.end() - 8))),
              at + ": the Draco data are damaged");
}

// Numbers in the data do not reserve memory.
TEST(GltfDraco, ManyVerticesNeedData) {
    Bytes packed = packed_mesh(false);
    packed.resize(11);
    for (int number = 0; number < 2; ++number) packed.insert(packed.end(), {0x80, 0x80, 0x80, 0x10}); // 2^25
    EXPECT_EQ(
        model_error(draco_model(packed, R"("POSITION": 0)", std::size_t{1} << 25, 3 * (std::size_t{1} << 25)))
                .find("with it, the file describes more than") != std::string::npos,
        true);
    packed.resize(11);
    for (int number = 0; number < 2; ++number) packed.insert(packed.end(), {0x80, 0x80, 0x40}); // 2^20
    EXPECT_EQ(
        model_error(
            draco_model(packed, R"("POSITION": 0)", std::size_t{1} << 20, 3 * (std::size_t{1} << 20))),
        "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression: the Draco data are too short for so "
        "many vertices or triangles");
}

TEST(GltfDraco, DamagedDataAreRefused) {
    for (const bool edgebreaker : {false, true})
        expect_refused_or_read(packed_mesh(edgebreaker), 0,
                               [](const Bytes& bytes) { return draco_model(bytes); });
}

#endif
#ifdef MONTELUX_WEBP

TEST(GltfWebp, PicturesAreReadAndPreferred) {
    const std::array<std::uint8_t, 6> pixels{10, 20, 30, 40, 50, 60};
    std::uint8_t* encoded = nullptr;
    const std::size_t size = WebPEncodeLosslessRGB(pixels.data(), 2, 1, 6, &encoded);
    ASSERT_GT(size, 0u);
    test::MemoryFiles files;
    files.files["folder/a.webp"] = Bytes(encoded, encoded + size);
    files.files["folder/a.png"] = {1, 2, 3};
    WebPFree(encoded);
    Model m;
    m.add_triangle();
    const auto load = [&](const std::string& texture) {
        return load_model(
            m.text(R"("materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
            "images": [{"uri": "a.webp"}, {"uri": "a.png"}], "textures": [{)" +
                   texture + "}], " + test::one_mesh(R"("attributes": {"POSITION": 0}, "material": 0)")),
            nullptr, {}, &files);
    };
    for (const char* fallback : {"", R"("source": 1, )"}) {
        const SceneDescription d =
            load(std::string(fallback) + R"("extensions": {"EXT_texture_webp": {"source": 0}})");
        const Image& image = d.scene.images.at(0);
        ASSERT_EQ(image.width(), 2);
        EXPECT_FLOAT_EQ(image.value(1, 0, 2), 60.0f / 255);
    }
}

#endif

} // namespace
} // namespace montelux
