// Scene formats are recognised by content; files of other kinds are named in the error.
#include "test/formats/gzip.h"
#include "test/temporary_folder.h"
#include <filesystem>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/formats/file_kind.h"
#include "montelux/formats/load_scene.h"
#include "montelux/formats/pbrt/load_pbrt.h"
#include "montelux/image/image_write.h"
#include "montelux/mc/io/generation_file.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/scene_digest.h"

namespace montelux {
namespace {

class LoadScene : public ::testing::Test {
  protected:
    std::string error_of(const std::filesystem::path& path) {
        try {
            load_scene(path, warnings_);
        } catch (const Error& e) {
            return e.what();
        }
        return {};
    }
    std::string refused(const std::string& name, const std::string& kind) {
        return (folder_ / name).string() + ": looks like " + kind +
               "; expected a scene of pbrt-v4 (.pbrt or .pbrt.gz) or glTF 2.0 (.gltf or .glb)";
    }

    TemporaryFolder folder_;
    Warnings warnings_;
};

TEST_F(LoadScene, ReadsPbrtWhateverItsName) {
    const std::string text =
        "# {\n\n  LookAt 0 0 4 0 0 0 0 1 0\nCamera \"perspective\"\nWorldBegin\nShape \"sphere\"\n";
    const std::vector<std::uint8_t> packed = gzip(text);
    const SceneDigest expected = digest_of(parse_pbrt(text, "scene", ".", warnings_).scene);
    for (const char* name : {"scene.pbrt", "scene", "scene.xml", "scene.png"})
        EXPECT_EQ(digest_of(load_scene(folder_.write(name, text), warnings_).scene), expected) << name;
    const auto zipped = folder_.write("scene.pbrt.gz", {packed.begin(), packed.end()});
    std::vector<std::filesystem::path> files_read;
    EXPECT_EQ(digest_of(load_scene(zipped, warnings_, {.files_read = &files_read}).scene), expected);
    EXPECT_EQ(files_read, std::vector{zipped});
}

TEST_F(LoadScene, OtherKindsAreNamed) {
    struct Case {
        std::string name, content, kind;
    };
    using namespace std::string_literals;
    const Case cases[] = {
        {"a.json", "{\"asset\": 1}", "a JSON file"},
        {"a.xml", "<scene version='0.6.0'>", "a Mitsuba scene (XML)"},
        {"b.xml", "\xef\xbb\xbf<?xml?>\n<!-- a comment -->\n<scene version=\"3.0.0\">",
         "a Mitsuba scene (XML)"},
        {"a.dae", "<?xml?><COLLADA>", "a COLLADA scene"},
        {"a.svg", "<svg xmlns=''>", "an SVG picture"},
        {"a.usda", "#usda 1.0\n", "a USD scene (text)"},
        {"a.obj", "# made by hand\n\nmtllib a.mtl\nv 0 0 0\n", "an OBJ mesh"},
        {"b.obj", "v 0 0 0\n", "an OBJ mesh"},
        {"a.stl", "solid ball\n", "an STL mesh"},
        {"a.tif", "II*\0\10\0\0\0"s, "a TIFF picture"},
        {"a.webp", "RIFF\1\2\3\4WEBPVP8 "s, "a WebP picture"},
        {"a.jpg", "\xff\xd8\xff\xe0", "a JPEG picture"},
        {"a.zip", "PK\3\4", "a ZIP archive"},
        {"a.bin", "WorldBegin\0Shape"s, "a binary file of no kind that is known"},
    };
    for (const Case& c : cases)
        EXPECT_EQ(error_of(folder_.write(c.name, c.content)), refused(c.name, c.kind));
    EXPECT_EQ(error_of(folder_.write("a.ply", "ply\nformat ascii 1.0\n")),
              refused("a.ply", "a PLY mesh") + ": a scene file of pbrt-v4 refers to it by Shape \"plymesh\"");
    const std::vector<std::uint8_t> packed = gzip("WorldBegin");
    EXPECT_EQ(error_of(folder_.write("packed.pbrt", {packed.begin(), packed.end()})),
              refused("packed.pbrt", "a gzip file") + ": the name of a compressed scene ends in .gz");
    const std::vector<std::uint8_t> packed_xml = gzip("<scene version='3.0.0'>");
    EXPECT_EQ(error_of(folder_.write("a.xml.gz", {packed_xml.begin(), packed_xml.end()})),
              refused("a.xml.gz", "a Mitsuba scene (XML)"));
}

TEST_F(LoadScene, ReadsGltfWhateverItsName) {
    const std::string text =
        "\n{\n \"accessors\": [], \"asset\": {\"version\": \"2.0\"}, \"cameras\": [], \"nodes\": []}";
    std::vector<std::filesystem::path> files_read;
    const auto path = folder_.write("scene.json", text);
    EXPECT_FALSE(load_scene(path, warnings_, {.files_read = &files_read}).has_camera);
    EXPECT_EQ(files_read, std::vector{path});
    const auto binary = folder_.write("scene.bin", "glTF");
    EXPECT_EQ(error_of(binary), binary.string() + ": ends within the header of a binary glTF file");
}

// What Montelux itself writes.
TEST_F(LoadScene, PicturesAndCheckpointsAreNamed) {
    Image picture(4, 4, {"R", "G", "B"});
    const std::pair<const char*, const char*> kinds[] = {{"p.exr", "an OpenEXR picture"},
                                                         {"p.png", "a PNG picture"},
                                                         {"p.hdr", "a Radiance HDR picture"},
                                                         {"p.pfm", "a PFM picture"}};
    for (const auto& [name, kind] : kinds) {
        write_image(folder_ / name, picture);
        EXPECT_EQ(error_of(folder_ / name), refused(name, kind));
    }
    write_generation(folder_ / "render.state", "render", std::vector<std::uint8_t>(100));
    EXPECT_EQ(error_of(folder_ / "render.state"),
              refused("render.state", "a checkpoint of Montelux") +
                  ": give the scene itself, with --checkpoint FILE --resume");
}

// Text of no kind that is known is pbrt's, with a place where it goes wrong.
TEST_F(LoadScene, TextIsLeftToTheReader) {
    const auto recipe = folder_.write("recipe.txt", "Boil two eggs.\n");
    EXPECT_EQ(error_of(recipe), recipe.string() + ":1:1: unknown directive 'Boil'");
    const auto empty = folder_.write("empty.pbrt", "");
    EXPECT_EQ(error_of(empty), empty.string() + ":1:1: the file ends before WorldBegin");
    EXPECT_NE(error_of(folder_ / "missing.pbrt"), "");
    EXPECT_NE(error_of(folder_.path()), "");
}

TEST_F(LoadScene, ScenesOfOtherFormatsAreNamed) {
    const std::filesystem::path scenes = std::filesystem::path(MONTELUX_SHARED_DIR) / "scenes";
    if (!std::filesystem::exists(scenes)) GTEST_SKIP() << "no shared files";
    int gltf = 0, mitsuba = 0, pbrt = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(scenes)) {
        const std::string ending = entry.path().extension().string();
        auto kind = [&] { return file_kind(DiskFiles().read(entry.path(), std::size_t{1} << 30)).name; };
        if (ending == ".gltf" || ending == ".glb") {
            EXPECT_TRUE(kind().starts_with("a glTF scene")) << entry.path();
            ++gltf;
        } else if (ending == ".pbrt") {
            EXPECT_EQ(kind(), "") << entry.path();
            ++pbrt;
        } else if (ending == ".xml" && entry.path().stem() == "cbox") {
            EXPECT_EQ(kind(), "a Mitsuba scene (XML)") << entry.path();
            ++mitsuba;
        }
    }
    EXPECT_GT(gltf, 5);
    EXPECT_GT(mitsuba, 0);
    EXPECT_GT(pbrt, 10);
}

} // namespace
} // namespace montelux
