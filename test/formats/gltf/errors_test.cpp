// Broken glTF files: each has its sentence, with the JSON pointer.
#include "test/formats/gltf/model.h"
#include <gtest/gtest.h>

#include "montelux/formats/load_scene.h"

namespace montelux {
namespace {

using test::load_model;
using test::Model;
using test::model_error;

std::string root(const std::string& members) { return R"({"asset": {"version": "2.0"}, )" + members + "}"; }

// A triangle by accessor 0; `primitive`, `node`: further members; `more`: of the root.
std::string broken(const std::string& primitive, const std::string& node = "", const std::string& more = "") {
    Model m;
    m.add_triangle();
    return m.text(R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0})" + primitive +
                  R"(}]}], "nodes": [{"mesh": 0)" + node + "}]" + more);
}

struct BrokenModel {
    std::string text, message;
};

void expect_messages(const std::vector<BrokenModel>& cases) {
    for (const BrokenModel& c : cases) EXPECT_EQ(model_error(c.text), c.message) << c.text;
}

TEST(GltfErrors, Json) {
    EXPECT_TRUE(model_error("{\n  \"asset\": }").starts_with("line 2, column 12: broken JSON: syntax error"));
    EXPECT_TRUE(model_error("{").starts_with("line 1, column 2: broken JSON: syntax error"));
    expect_messages({{"[]", "an array; expected an object"}, {"{}", "has no 'asset', which glTF demands"}});
    // Neither the parser nor the readers call themselves for each level.
    EXPECT_NE(model_error(std::string(1 << 20, '[')), "");
}

TEST(GltfErrors, Asset) {
    expect_messages(
        {{R"({"asset": {"version": "1.0"}})", "/asset/version: version '1.0' of glTF; expected 2.0"},
         {R"({"asset": {"version": "two"}})", "/asset/version: version 'two' of glTF; expected 2.0"},
         {R"({"asset": {"version": 2}})", "/asset/version: the number 2; expected a text"},
         {R"({"asset": {"version": "2.0", "minVersion": "2.1"}})",
          "/asset/minVersion: needs version '2.1' of glTF"},
         {root(R"("extensionsRequired": ["KHR_animated_toast"])"),
          "/extensionsRequired/0: the scene requires the extension 'KHR_animated_toast', which is not "
          "supported"}});
    Warnings warnings;
    load_model(root(R"("extensionsUsed": ["A_b", "KHR_lights_punctual", "C_d"])"), &warnings);
    EXPECT_EQ(warnings.messages().at(0), "folder/model.gltf: extensions that are ignored: A_b, C_d");
}

TEST(GltfErrors, Buffers) {
    const auto one = [](const std::string& buffer, const std::string& view) {
        return root(
            R"("buffers": [{)" + buffer + R"(}], "bufferViews": [{)" + view +
            R"(}], "accessors": [{"bufferView": 0, "componentType": 5126, "count": 1, "type": "VEC3"}], )" +
            test::one_mesh(R"("attributes": {"POSITION": 0})"));
    };
    const std::string data = R"("byteLength": 3, "uri": "data:;base64,AAAA")",
                      view = R"("buffer": 0, "byteLength": 3)";
    expect_messages(
        {{one(data, view), "/accessors/0: 1 elements need 12 bytes of the buffer view, which has 3"},
         {one(data, R"("buffer": 7, "byteLength": 3)"),
          "/bufferViews/0/buffer: buffer 7 does not exist (there are 1)"},
         {one(data, R"("buffer": 0, "byteOffset": 2, "byteLength": 3)"),
          "/bufferViews/0: bytes 2 to 5 are not within its buffer of 3 bytes"},
         {one(R"("byteLength": 3)", view), "/buffers/0: has no 'uri', and there is no binary chunk for it"},
         {one(R"("byteLength": 4, "uri": "data:;base64,AAAA")", view),
          "/buffers/0: has 3 bytes; its byteLength is 4"},
         {one(R"("byteLength": -3, "uri": "data:;base64,AAAA")", view),
          "/buffers/0/byteLength: the number -3; expected an integer that is not negative"},
         {one(R"("byteLength": 3, "uri": "data:text/plain,AAAA")", view),
          "/buffers/0/uri: a data URI that is not in base64"},
         {one(R"("byteLength": 3, "uri": "data:;base64,A*AA")", view),
          "/buffers/0/uri: a data URI with a character that is not base64"},
         {one(R"("byteLength": 3, "uri": "http://example.org/a.bin")", view),
          "/buffers/0/uri: the URI 'http://example.org/a.bin' is not a file; expected a relative name or a "
          "data URI"},
         {one(R"("byteLength": 3, "uri": "/etc/passwd")", view),
          "/buffers/0/uri: the URI '/etc/passwd' leads out of the folder of the glTF file; such files are "
          "not read"},
         {one(R"("byteLength": 3, "uri": "a/%2e%2E/../b")", view),
          "/buffers/0/uri: the URI 'a/%2e%2E/../b' leads out of the folder of the glTF file; such files are "
          "not read"},
         {one(R"("byteLength": 3, "uri": "a%4")", view),
          "/buffers/0/uri: the URI 'a%4' has a '%' without two hexadecimal digits"},
         {one(R"("byteLength": 3, "uri": "a%00")", view), "/buffers/0/uri: the URI 'a%00' has a NUL byte"},
         {one(R"("byteLength": 3, "uri": "")", view), "/buffers/0/uri: an empty URI"},
         {one(R"("byteLength": 3, "uri": "gone.bin")", view),
          "/buffers/0/uri: there is no file 'folder/gone.bin'"},
         {one(data, view + R"(, "extensions": {"EXT_meshopt_compression": {}})"),
          "/bufferViews/0/extensions/EXT_meshopt_compression: has no 'count', which glTF demands"},
         {one(data, view + R"(, "extensions": {"KHR_meshopt_compression": {}})"),
          "/bufferViews/0: is compressed by KHR_meshopt_compression, which is not read"}});
}

TEST(GltfErrors, Accessors) {
    const auto one = [](const std::string& accessor) {
        return root(R"("buffers": [{"byteLength": 3, "uri": "data:;base64,AAAA"}],
            "bufferViews": [{"buffer": 0, "byteLength": 3, "byteStride": 300}], "accessors": [{)" +
                    accessor + "}], " + test::one_mesh(R"("attributes": {"POSITION": 0})"));
    };
    expect_messages(
        {{one(R"("componentType": 5126, "count": 0, "type": "VEC3")"), "/accessors/0/count: 0 is below 1"},
         {one(R"("componentType": 5126, "count": 1e10, "type": "VEC3")"),
          "/accessors/0/count: more than 2^32 elements"},
         {one(R"("componentType": 5124, "count": 1, "type": "VEC3")"),
          "/accessors/0/componentType: component type 5124 is unknown; expected 5120, 5121, 5122, 5123, 5125 "
          "or 5126"},
         {one(R"("componentType": 5126, "count": 1, "type": "VEC5")"),
          "/accessors/0/type: unknown type 'VEC5'; expected SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4"},
         {one(R"("componentType": 5126, "count": 1, "type": "VEC2")"),
          "/meshes/0/primitives/0/attributes/POSITION: accessor 0 is of type VEC2; expected VEC3"},
         {one(R"("bufferView": 0, "componentType": 5121, "count": 1, "type": "VEC3")"),
          "/bufferViews/0/byteStride: a stride of 300 bytes; expected 3 to 252"},
         {one(R"("bufferView": 3, "componentType": 5121, "count": 1, "type": "VEC3")"),
          "/accessors/0/bufferView: buffer view 3 does not exist (there are 1)"},
         {one(R"("componentType": 5126, "count": 1000000000, "type": "VEC3")"),
          "/meshes/0/primitives/0: with it, the file describes more than 64 times the bytes that it has: it "
          "refers to "
          "the same data again and again"}});
    Model infinite;
    infinite.add<float>({0, 0, 0, 1, 0, 0, 0, std::numeric_limits<float>::infinity(), 0}, "VEC3");
    Model nan;
    nan.add<float>({0, 0, 0, 1, 0, 0, 0, std::numeric_limits<float>::quiet_NaN(), 0}, "VEC3");
    for (const Model& m : {infinite, nan})
        EXPECT_EQ(model_error(m.text(test::one_mesh(R"("attributes": {"POSITION": 0})"))),
                  "/accessors/0: element 2 is not a finite number");
}

TEST(GltfErrors, Meshes) {
    Model m;
    m.add_triangle();
    m.add<std::uint16_t>({0, 1, 3}, "SCALAR");
    m.add<float>({0, 1, 2}, "SCALAR");
    m.add<float>({0, 0, 1}, "VEC3");
    m.add<float>({7, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
    m.add<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    const auto primitive = [&](const std::string& members, const std::string& attributes = "",
                               const std::string& node = "", const std::string& more = "") {
        return m.text(R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0)" + attributes + "}" +
                      members + R"(}]}], "nodes": [{"mesh": 0)" + node + "}]" + more);
    };
    expect_messages(
        {{primitive(R"(, "indices": 17)"),
          "/meshes/0/primitives/0/indices: accessor 17 does not exist (there are 6)"},
         {primitive(R"(, "indices": 1)"),
          "/meshes/0/primitives/0/indices: index 2 refers to vertex 3; there are 3"},
         {primitive(R"(, "indices": 2)"), "/accessors/2: indices are not unsigned integers"},
         {primitive(R"(, "indices": "1")"),
          "/meshes/0/primitives/0/indices: the text '1'; expected an integer that is not negative"},
         {primitive(R"(, "indices": 1.5)"),
          "/meshes/0/primitives/0/indices: the number 1.5; expected an integer that is not negative"},
         {primitive(R"(, "mode": 7)"), "/meshes/0/primitives/0/mode: mode 7 is above 6"},
         {primitive("", R"(, "NORMAL": 3)"),
          "/meshes/0/primitives/0/attributes/NORMAL: has 1 elements for 3 positions"},
         {primitive(R"(, "material": 0)"),
          "/meshes/0/primitives/0/material: material 0 does not exist (there are 0)"},
         {primitive(R"(, "extensions": {"KHR_draco_mesh_compression": {}})"),
          "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression: has no 'bufferView', which glTF "
          "demands"},
         {primitive(R"(, "targets": [{}])", "", R"(, "weights": [1, 2])"),
          "/nodes/0/weights: an array of 2 values; expected 1 numbers"},
         {primitive("", "", R"(, "skin": 0)", R"(, "skins": [{"joints": [0]}])"),
          "/meshes/0/primitives/0: has no JOINTS_0 and WEIGHTS_0, which its skin needs"},
         {primitive("", R"(, "JOINTS_0": 4, "WEIGHTS_0": 5)", R"(, "skin": 0)",
                    R"(, "skins": [{"joints": [0]}])"),
          "/accessors/4: refers to joint 7; the skin has 1"},
         {primitive("", "", R"(, "skin": 0)", R"(, "skins": [{"joints": []}])"), "/skins/0: has no joints"},
         {primitive("", "", R"(, "skin": 1)"), "/nodes/0/skin: skin 1 does not exist (there are 0)"},
         {root(R"("meshes": [{"primitives": [{}]}], "nodes": [{"mesh": 0}])"),
          "/meshes/0/primitives/0: has no 'attributes', which glTF demands"}});
}

TEST(GltfErrors, Nodes) {
    expect_messages(
        {{broken("", R"(, "children": [0])"), "/nodes/0: the node is its own ancestor"},
         {broken("", R"(, "children": [4])"), "/nodes/0/children/0: node 4 does not exist (there are 1)"},
         {root(R"("nodes": [{"children": [1]}, {"children": [0]}])"),
          "/nodes/0: the node is its own ancestor"},
         {root(R"("nodes": [{"children": [2]}, {"children": [2]}, {}])"),
          "/nodes/1/children/0: node 2 is a child of node 0 already; nodes form trees"},
         {broken("", R"(, "translation": [1, 2])"),
          "/nodes/0/translation: an array of 2 values; expected 3 numbers"},
         {broken("", R"(, "translation": [1, 2, "3"])"),
          "/nodes/0/translation/2: the text '3'; expected a number"},
         {broken("", R"(, "translation": [1, 2, 1e39])"),
          "/nodes/0/translation/2: the number 1e+39 is beyond what single-precision numbers hold"},
         {broken("", R"(, "rotation": [0, 0, 0, 0])"), "/nodes/0/rotation: a quaternion of length 0"},
         {broken("", R"(, "matrix": [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])"),
          "/nodes/0/matrix: a projective matrix; expected 0 0 0 1 in its last row"},
         {broken("", "", R"(, "scene": 2, "scenes": [{}])"), "/scene: scene 2 does not exist (there are 1)"},
         {broken("", "", R"(, "scenes": [{"nodes": [1]}])"),
          "/scenes/0/nodes/0: node 1 does not exist (there are 1)"},
         {root(R"("nodes": [{"mesh": 3}])"), "/nodes/0/mesh: mesh 3 does not exist (there are 0)"},
         {root(R"("nodes": [{"camera": 0}])"), "/nodes/0/camera: camera 0 does not exist (there are 0)"},
         {root(R"("nodes": [{"camera": 0}], "cameras": [{"type": "lens"}])"),
          "/cameras/0/type: unknown camera 'lens'; expected 'perspective' or 'orthographic'"},
         {root(
              R"("nodes": [{"camera": 0}], "cameras": [{"type": "perspective", "perspective": {"yfov": 4}}])"),
          "/cameras/0/perspective/yfov: 4 is not between 0 and pi"},
         {root(R"("nodes": [{"extensions": {"KHR_lights_punctual": {"light": 0}}}])"),
          "/nodes/0/extensions/KHR_lights_punctual/light: light 0 does not exist (there are 0)"},
         {root(R"("extensions": {"KHR_lights_punctual": {"lights": [{"type": "sun"}]}},
                  "nodes": [{"extensions": {"KHR_lights_punctual": {"light": 0}}}])"),
          "/extensions/KHR_lights_punctual/lights/0/type: unknown light 'sun'; expected 'directional', "
          "'point' or "
          "'spot'"}});
}

TEST(GltfErrors, Animations) {
    Model m;
    m.add_triangle();
    m.add<float>({2, 1}, "SCALAR");
    m.add<float>({1, 2}, "SCALAR");
    const auto animation = [&](const std::string& target, const std::string& sampler) {
        return m.text(R"("nodes": [{}], "animations": [{"channels": [{"sampler": 0, "target": {)" + target +
                      R"(}}], "samplers": [{)" + sampler + "}]}]");
    };
    const std::string target = R"("node": 0, "path": "translation")";
    const auto error = [](const std::string& text) { return model_error(text, {.time = 0}); };
    EXPECT_EQ(error(animation(target, R"("input": 1, "output": 0)")),
              "/animations/0/samplers/0/input: the times of keys do not grow");
    EXPECT_EQ(error(animation(target, R"("input": 2, "output": 0)")),
              "/animations/0/samplers/0/output: has 9 numbers; 2 keys need 6");
    EXPECT_EQ(
        error(animation(target, R"("input": 2, "output": 0, "interpolation": "LINEAL")")),
        "/animations/0/samplers/0/interpolation: unknown interpolation 'LINEAL' (did you mean 'LINEAR'?)");
    EXPECT_EQ(error(animation(R"("node": 5, "path": "translation")", "")),
              "/animations/0/channels/0/target/node: node 5 does not exist (there are 1)");
}

TEST(GltfErrors, Materials) {
    const auto material = [](const std::string& members, const std::string& more = "") {
        return broken(R"(, "material": 0)", "", R"(, "materials": [{)" + members + "}]" + more);
    };
    const std::string texture = R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0}})";
    expect_messages(
        {{material(R"("alphaMode": "BLAND")"),
          "/materials/0/alphaMode: unknown mode 'BLAND' (did you mean 'BLEND'?)"},
         {material(R"("pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 2]})"),
          "/materials/0/pbrMetallicRoughness/baseColorFactor/3: 2 is not between 0 and 1"},
         {material(R"("emissiveFactor": [1, -1, 1])"),
          "/materials/0/emissiveFactor: a colour with a negative component"},
         {material(R"("extensions": {"KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 0,
                      "attenuationColor": [0.5, 1, 1]}})"),
          "/materials/0/extensions/KHR_materials_volume/attenuationDistance: 0 is no distance"},
         {material(texture),
          "/materials/0/pbrMetallicRoughness/baseColorTexture/index: texture 0 does not exist (there "
          "are 0)"},
         {material(texture, R"(, "textures": [{}])"), "/textures/0: has no 'source'"},
         {material(texture, R"(, "textures": [{"source": 0}])"),
          "/textures/0/source: image 0 does not exist (there are 0)"},
         {material(texture, R"(, "textures": [{"extensions": {"KHR_texture_basisu": {"source": 0}}}])"),
          "/textures/0: has a picture of KHR_texture_basisu only, which is not read; expected a PNG or JPEG "
          "picture "
          "beside it"}});
    EXPECT_EQ(model_error(material(texture, R"(, "textures": [{"source": 0}],
                  "images": [{"uri": "data:;base64,AAAA"}])"))
                  .substr(0, 11),
              "/images/0: ");
    EXPECT_EQ(model_error(material(""), {.variant = "red"}), "there is no variant 'red'; the file has none");
    const std::string variants =
        R"(, "extensions": {"KHR_materials_variants": {"variants": [{"name": "red"}, {"name": "blue"}]}})";
    EXPECT_EQ(model_error(material("", variants), {.variant = "rod"}),
              "there is no variant 'rod' (did you mean 'red'?); expected 'red', 'blue'");
}

// Headers and chunks.
TEST(GltfErrors, Binary) {
    const auto word = [](std::uint32_t w) {
        return std::string{char(w & 255), char(w >> 8 & 255), char(w >> 16 & 255), char(w >> 24 & 255)};
    };
    const auto file = [&](std::uint32_t version, std::uint32_t length, const std::string& rest) {
        return "glTF" + word(version) + word(length) + rest;
    };
    const std::string json = R"({"asset": {"version": "2.0"}}   )", chunk = word(32) + "JSON" + json;
    EXPECT_EQ(model_error(file(2, 52, chunk)), "");
    expect_messages({{"glTF\2", "ends within the header of a binary glTF file"},
                     {file(1, 52, chunk), "is version 1 of binary glTF; expected 2"},
                     {file(2, 99, chunk), "has 52 bytes; its header says 99"},
                     {file(2, 3, chunk), "has no JSON chunk"},
                     {file(2, 52, word(32) + "JSOM" + json), "its first chunk is not JSON"},
                     {file(2, 52, word(33) + "JSON" + json),
                      "a chunk of 33 bytes begins at byte 20; the file ends at 52"}});
}

TEST(GltfErrors, ChoicesOfGltfAreRefusedByPbrt) {
    test::MemoryFiles files;
    const std::string text = "WorldBegin\n";
    files.files["a.pbrt"].assign(text.begin(), text.end());
    Warnings warnings;
    const auto error = [&](LoadOptions options) -> std::string {
        options.source = &files;
        try {
            load_scene("a.pbrt", warnings, options);
        } catch (const Error& e) {
            return e.what();
        }
        return {};
    };
    EXPECT_EQ(error({.camera = "a"}), "a.pbrt: only glTF and Mitsuba scenes have a choice of cameras");
    EXPECT_EQ(error({.variant = "a"}), "a.pbrt: only glTF scenes have variants of materials");
    EXPECT_EQ(error({.time = 1}), "a.pbrt: only glTF scenes have a time of animations");
    EXPECT_EQ(error({.shutter = 1}), "shutter: expected a time of the animations, when it opens");
    EXPECT_EQ(error({.time = 1, .shutter = -1}),
              "shutter: expected a number of seconds that is not negative");
}

} // namespace
} // namespace montelux
