// Khronos' sample models load, and have what their descriptions say.
#include "test/formats/gltf/model.h"
#include <filesystem>
#include <gtest/gtest.h>
#include <set>

#include "montelux/formats/load_scene.h"

namespace montelux {
namespace {

const std::filesystem::path shared(MONTELUX_SHARED_DIR);

class GltfConformance : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!std::filesystem::exists(shared / "scenes" / "gltf-conformance"))
            GTEST_SKIP() << "no shared files";
    }
    SceneDescription load(const std::string& model, const LoadOptions& options = {}) {
        return load_scene(shared / "scenes" / "gltf-conformance" / model, warnings_, options);
    }

    Warnings warnings_;
};

// The large ones are read by the test of their own feature.
TEST_F(GltfConformance, AllLoad) {
    int count = 0;
    for (const char* folder : {"gltf-conformance", "gltf"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(shared / "scenes" / folder)) {
            const std::string ending = entry.path().extension().string();
            if (ending != ".gltf" && ending != ".glb") continue;
            if (ending == ".glb" && entry.file_size() > 300'000) continue;
            EXPECT_NO_THROW({
                const SceneDescription d = load_scene(entry.path(), warnings_);
                EXPECT_FALSE(d.scene.shapes.empty()) << entry.path();
            }) << entry.path();
            ++count;
        }
    EXPECT_GT(count, 30);
}

// Text and binary, with indices and without, interleaved and not.
TEST_F(GltfConformance, TheSameBoxInAllContainers) {
    const SceneDescription expected = load("Box/glTF/Box.gltf");
    ASSERT_EQ(expected.scene.meshes.size(), 1u);
    EXPECT_EQ(expected.scene.meshes[0].triangle_count(), 12u);
    for (const char* other : {"Box/glTF-Binary/Box.glb", "Box/glTF-Embedded/Box.gltf"}) {
        const SceneDescription d = load(other);
        EXPECT_EQ(d.scene.meshes.at(0).positions, expected.scene.meshes[0].positions) << other;
        EXPECT_EQ(d.scene.meshes.at(0).normals, expected.scene.meshes[0].normals) << other;
    }
    const SceneDescription interleaved = load("BoxInterleaved/glTF/BoxInterleaved.gltf");
    EXPECT_EQ(interleaved.scene.meshes.at(0).positions,
              load("BoxInterleaved/glTF-Binary/BoxInterleaved.glb").scene.meshes.at(0).positions);
}

TEST_F(GltfConformance, Features) {
    EXPECT_TRUE(load("Cameras/glTF/Cameras.gltf").has_camera);
    EXPECT_TRUE(std::holds_alternative<OrthographicCamera>(
        load("Cameras/glTF/Cameras.gltf", {.camera = "1"}).scene.camera.model));
    EXPECT_EQ(load("SimpleInstancing/glTF/SimpleInstancing.gltf").scene.instances.size(), 125u);
    EXPECT_FALSE(load("BoxVertexColors/glTF/BoxVertexColors.gltf").scene.meshes.at(0).colors.empty());
    EXPECT_EQ(load("SimpleMeshes/glTF/SimpleMeshes.gltf").scene.instances.size(), 2u);
    // The bar bends: its upper end leaves x = 0.
    const auto top = [&](double time) {
        const SceneDescription d = load("SimpleSkin/glTF/SimpleSkin.gltf", {.time = time});
        return d.scene.meshes.at(0).positions.back();
    };
    EXPECT_GT(length(top(1) - top(0)), 0.1f);
    // Names with characters of other scripts.
    EXPECT_EQ(load("Unicode❤♻Test/glTF/Unicode❤♻Test.gltf").scene.meshes.size(), 1u);
}

TEST_F(GltfConformance, BrokenModelsAreRefused) {
    const auto error = [&](const std::string& model) -> std::string {
        const std::filesystem::path path = shared / "bad" / "models" / model;
        try {
            load_scene(path, warnings_);
        } catch (const Error& e) {
            const std::string what = e.what(), name = path.string() + ": ";
            return what.starts_with(name) ? what.substr(name.size()) : what;
        }
        return {};
    };
    EXPECT_EQ(error("IndexOutOfRange/IndexOutOfRange.gltf"),
              "/meshes/0/primitives/0/indices: index 0 refers to vertex 255; there are 24");
    EXPECT_NE(error("RecursiveNodes/RecursiveNodes.gltf"), "");
    for (const char* name : {"badArray", "badExtension", "badNumber", "badObject", "badUint"})
        EXPECT_NE(error("wrongTypes/" + std::string(name) + ".gltf"), "") << name;
}

} // namespace
} // namespace montelux
