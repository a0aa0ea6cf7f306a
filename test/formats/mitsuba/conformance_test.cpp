// The scenes of Mitsuba's documentation and tests load, or say which plugin is not supported.
#include "test/formats/mitsuba/shared_scenes.h"
#include "test/sanitized.h"
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

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

    struct Counts {
        int loaded = 0, refused = 0;
    };
    Counts expect_loaded_or_refused(const std::vector<std::filesystem::path>& paths) {
        Counts counts;
        for (const std::filesystem::path& path : paths) {
            try {
                const SceneDescription d = load_with_samples(path);
                EXPECT_FALSE(d.scene.shapes.empty()) << path;
                EXPECT_TRUE(d.has_camera) << path;
                ++counts.loaded;
            } catch (const Error& e) {
                const std::string message = e.what();
                const bool explained = message.find("is not supported") != std::string::npos ||
                                       message.find("there is no file") != std::string::npos;
                EXPECT_TRUE(explained) << message;
                ++counts.refused;
            }
        }
        RecordProperty("loaded", counts.loaded);
        RecordProperty("refused", counts.refused);
        return counts;
    }
};
class MitsubaConformanceSlowTest : public MitsubaConformance {};

// Parts of scenes, which others include.
bool is_part(const std::filesystem::path& path) {
    const std::set<std::string> folders{"include", "fragments"};
    return folders.contains(path.parent_path().filename().string());
}

std::vector<std::filesystem::path> all_scenes() {
    std::vector<std::filesystem::path> paths;
    for (const char* folder : {"docs/scenes", "scenes", "tests"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(mitsuba_scenes() / folder))
            if (entry.path().extension() == ".xml" && !is_part(entry.path())) paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    return paths;
}

// Scenes that name a plugin, a parameter or a file that none before them does.
std::vector<std::filesystem::path> scenes_with_new_words() {
    static const std::regex attribute("(?:type|name|filename)=\"([^\"]*)\"");
    std::set<std::string> known;
    std::vector<std::filesystem::path> paths;
    for (const std::filesystem::path& path : all_scenes()) {
        std::ifstream file(path);
        const std::string text(std::istreambuf_iterator<char>(file), {});
        const std::size_t before = known.size();
        for (std::sregex_iterator word(text.begin(), text.end(), attribute), end; word != end; ++word)
            known.insert((*word)[1]);
        if (known.size() > before) paths.push_back(path);
    }
    return paths;
}

TEST_F(MitsubaConformance, ScenesWithNewWordsLoadOrSayWhyNot) {
    const std::vector<std::filesystem::path> scenes = scenes_with_new_words();
    std::vector<std::filesystem::path> some;
    for (std::size_t i = 0; i < scenes.size(); i += under_sanitizers ? 4 : 1) some.push_back(scenes[i]);
    const Counts counts = expect_loaded_or_refused(some);
    EXPECT_GT(counts.loaded, under_sanitizers ? 8 : 35);
    EXPECT_LT(counts.refused, 15);
}

TEST_F(MitsubaConformanceSlowTest, AllLoadOrSayWhyNot) {
    const Counts counts = expect_loaded_or_refused(all_scenes());
    EXPECT_GT(counts.loaded, 90);
    EXPECT_LT(counts.refused, 30);
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
