// The scenes of Mitsuba's documentation and tests load, or say which plugin is not supported.
#include "test/formats/mitsuba/shared_scenes.h"
#include <filesystem>
#include <gtest/gtest.h>
#include <set>
#include <string>

#include "montelux/formats/load_scene.h"
#include "montelux/mc/math/error.h"

namespace montelux::mitsuba_conformance {
namespace {

using test::mitsuba_scenes;

class MitsubaConformance : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!std::filesystem::exists(mitsuba_scenes())) GTEST_SKIP() << "no shared files";
    }
    SceneDescription load(const std::filesystem::path& path, const LoadOptions& options = {}) {
        Warnings warnings;
        return load_scene(path, warnings, options);
    }
    // Some scenes leave the number of samples to the user.
    SceneDescription load_with_samples(const std::filesystem::path& path) {
        try {
            return load(path);
        } catch (const Error& e) {
            if (std::string(e.what()).find("$spp") == std::string::npos) throw;
        }
        LoadOptions options;
        options.definitions["spp"] = "16";
        return load(path, options);
    }
};

// Parts of scenes, which others include.
bool is_part(const std::filesystem::path& path) {
    const std::set<std::string> folders{"include", "fragments"};
    return folders.contains(path.parent_path().filename().string());
}

TEST_F(MitsubaConformance, AllLoadOrSayWhyNot) {
    int loaded = 0, refused = 0;
    for (const char* folder : {"docs/scenes", "scenes", "tests"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(mitsuba_scenes() / folder)) {
            if (entry.path().extension() != ".xml" || is_part(entry.path())) continue;
            try {
                const SceneDescription d = load_with_samples(entry.path());
                EXPECT_FALSE(d.scene.shapes.empty()) << entry.path();
                EXPECT_TRUE(d.has_camera) << entry.path();
                ++loaded;
            } catch (const Error& e) {
                const std::string message = e.what();
                const bool explained = message.find("is not supported") != std::string::npos ||
                                       message.find("there is no file") != std::string::npos;
                EXPECT_TRUE(explained) << message;
                ++refused;
            }
        }
    RecordProperty("loaded", loaded);
    RecordProperty("refused", refused);
    EXPECT_GT(loaded, 90);
    EXPECT_LT(refused, 30);
}

TEST_F(MitsubaConformance, Shapes) {
    const SceneDescription spheres = load(mitsuba_scenes() / "docs/scenes/shape_sphere_basic.xml");
    EXPECT_EQ(spheres.scene.quadrics.size(), 1u);
    EXPECT_EQ(load(mitsuba_scenes() / "docs/scenes/shape_disk.xml").scene.shapes.size(), 2u);
    const SceneDescription curves = load(mitsuba_scenes() / "docs/scenes/shape_bsplinecurve_basic.xml");
    ASSERT_EQ(curves.scene.curves.size(), 1u);
    EXPECT_EQ(curves.scene.curves[0].segment_count(), 4u);
    const SceneDescription instances = load(mitsuba_scenes() / "tests/instancing/test_instancing_path.xml");
    EXPECT_EQ(instances.scene.instances.size(), 3u);
}

} // namespace
} // namespace montelux::mitsuba_conformance
