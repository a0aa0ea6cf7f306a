// A scene can be read again from the recorded files.
#include "test/temporary_folder.h"
#include <filesystem>
#include <gtest/gtest.h>

#include "montelux/formats/file_source.h"
#include "montelux/formats/pbrt/load_pbrt.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/scene_digest.h"

namespace montelux {
namespace {

class FileSources : public ::testing::Test {
  protected:
    FileSources() {
        folder_.write("main.pbrt",
                      "LookAt 0 0 4 0 0 0 0 1 0 Camera \"perspective\"\nWorldBegin\n"
                      "LightSource \"infinite\" \"spectrum L\" \"light.spd\"\nInclude \"parts/ball.pbrt\"\n");
        folder_.write("parts/ball.pbrt",
                      "Shape \"sphere\"\nMaterial \"diffuse\" \"spectrum reflectance\" \"grey.spd\"\n");
        folder_.write("parts/grey.spd", "400 0.5 700 0.5\n"); // found beside the file that names it
        folder_.write("light.spd", "400 1 700 2\n");
    }

    TemporaryFolder folder_;
};

TEST_F(FileSources, BundlesStandInForTheDisk) {
    Warnings warnings;
    RecordedFiles recorded;
    std::vector<std::filesystem::path> read, read_again;
    const SceneDescription first = load_pbrt(folder_ / "main.pbrt", warnings, &read, &recorded);
    EXPECT_EQ(read.size(), 4u);
    const std::vector<std::uint8_t> bytes = recorded.bundle().to_bytes();
    std::filesystem::remove_all(folder_.path());

    BundledFiles bundled(FileBundle::from_bytes(bytes));
    const SceneDescription second = load_pbrt(folder_ / "main.pbrt", warnings, &read_again, &bundled);
    EXPECT_EQ(digest_of(second.scene), digest_of(first.scene));
    EXPECT_EQ(read_again, read);
    EXPECT_EQ(second.scene.lights.size(), first.scene.lights.size());
    EXPECT_THROW(load_pbrt(folder_ / "main.pbrt", warnings), Error); // the disk has nothing left
    EXPECT_THROW(load_pbrt(folder_ / "other.pbrt", warnings, nullptr, &bundled), Error);
}

TEST_F(FileSources, DamagedBundlesAreRefused) {
    RecordedFiles recorded;
    recorded.exists(folder_ / "light.spd");
    EXPECT_EQ(recorded.read(folder_ / "light.spd", 100).size(), 12u);
    EXPECT_THROW(recorded.read(folder_ / "main.pbrt", 10), Error); // too long
    std::vector<std::uint8_t> bytes = recorded.bundle().to_bytes();
    EXPECT_EQ(FileBundle::from_bytes(bytes).contents.size(), 1u);
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_THROW(FileBundle::from_bytes(std::span(bytes).first(size)), Error) << size;
    bytes.push_back(0);
    EXPECT_THROW(FileBundle::from_bytes(bytes), Error);
}

} // namespace
} // namespace montelux
