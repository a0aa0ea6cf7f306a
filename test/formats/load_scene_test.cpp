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
        return (folder_ / name).string() + ": this is " + kind +
               "; pbrt-v4, glTF 2.0, Mitsuba 3, OBJ, PLY and STL are read";
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
        {"a.xml", "<scenery version='0.6.0'>", "an XML file"},
        {"b.xml", "<!-- <scene> -->\n<story/>", "an XML file"},
        {"a.dae", "<?xml?><COLLADA>", "a COLLADA scene"},
        {"a.svg", "<svg xmlns=''>", "an SVG picture"},
        {"a.usda", "#usda 1.0\n", "a USD scene (text)"},
        {"a.off", "OFF\n8 6 0\n", "an OFF mesh"},
        {"a.tif", "II*\0\10\0\0\0"s, "a TIFF picture"},
        {"a.webp", "RIFF\1\2\3\4WEBPVP8 "s, "a WebP picture"},
        {"a.jpg", "\xff\xd8\xff\xe0", "a JPEG picture"},
        {"a.zip", "PK\3\4", "a ZIP archive"},
        {"a.bin", "WorldBegin\0Shape"s, "a binary file of an unknown kind"},
    };
    for (const Case& c : cases)
        EXPECT_EQ(error_of(folder_.write(c.name, c.content)), refused(c.name, c.kind));
    const std::vector<std::uint8_t> packed = gzip("WorldBegin");
    EXPECT_EQ(error_of(folder_.write("packed.pbrt", {packed.begin(), packed.end()})),
              refused("packed.pbrt", "a gzip file") + ": the name of a compressed scene ends in .gz");
    const std::vector<std::uint8_t> packed_xml = gzip("<COLLADA>");
    EXPECT_EQ(error_of(folder_.write("a.xml.gz", {packed_xml.begin(), packed_xml.end()})),
              refused("a.xml.gz", "a COLLADA scene"));
}

TEST_F(LoadScene, MitsubaScenesAreRecognised) {
    for (const std::string text :
         {"<scene version='3.0.0'><shape type='cube'/></scene>",
          "\xef\xbb\xbf<?xml version='1.0'?>\n<!-- <a> -->\n<scene\n version='0.6.0'>"
          "<shape type='cube'/></scene>"}) {
        Warnings warnings;
        EXPECT_EQ(load_scene(folder_.write("any name", text), warnings).scene.shapes.size(), 1u) << text;
        const std::vector<std::uint8_t> packed = gzip(text);
        EXPECT_EQ(
            load_scene(folder_.write("a.gz", {packed.begin(), packed.end()}), warnings).scene.shapes.size(),
            1u);
    }
}

TEST_F(LoadScene, MeshesAreModels) {
    const std::string stl =
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
        "endloop\nendfacet\nendsolid\n";
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::string binary(80, ' ');
    binary += std::string("\1\0\0\0", 4) + std::string(12, '\0');
    for (const float x : {0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f})
        binary.append(reinterpret_cast<const char*>(&x), 4);
    binary += std::string(2, '\0');
    const std::pair<const char*, std::string> files[] = {
        {"a.obj", obj},         {"b", "# made by hand\n\n\ng all\n" + obj},
        {"c", "s off\n" + obj}, {"d", "vt 0 0\n" + obj},
        {"a.ply", ply},         {"a.stl", stl},
        {"b.stl", binary},      {"f", binary}};
    for (const auto& [name, content] : files) {
        const SceneDescription d = load_scene(folder_.write(name, content), warnings_);
        ASSERT_EQ(d.scene.meshes.size(), 1u) << name;
        EXPECT_EQ(d.scene.meshes[0].indices, (std::vector<Index>{0, 1, 2})) << name;
        EXPECT_EQ(d.scene.meshes[0].normals[0], (Normal3f{0, 0, 1})) << name;
        EXPECT_TRUE(d.wants_studio && !d.has_camera) << name;
    }
    EXPECT_TRUE(warnings_.messages().empty());
    const std::vector<std::uint8_t> packed = gzip(obj);
    const auto zipped = folder_.write("a.obj.gz", {packed.begin(), packed.end()});
    std::vector<std::filesystem::path> files_read;
    EXPECT_EQ(load_scene(zipped, warnings_, {.files_read = &files_read}).scene.meshes.size(), 1u);
    EXPECT_EQ(files_read, std::vector{zipped});
    // What is not a mesh after all.
    EXPECT_EQ(error_of(folder_.write("e.obj", "v 0 0 0\n")),
              (folder_ / "e.obj").string() + ": the file has no faces");
    EXPECT_EQ(error_of(folder_.write("cut.stl", binary.substr(0, 100))),
              (folder_ / "cut.stl").string() +
                  ": an STL file of 1 triangles has 134 bytes; this one ends after 100");
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
    EXPECT_EQ(error_of(empty), empty.string() + ": the file is empty");
    EXPECT_NE(error_of(folder_ / "missing.pbrt"), "");
    EXPECT_NE(error_of(folder_.path()), "");
}

TEST_F(LoadScene, ScenesOfOtherFormatsAreNamed) {
    const std::filesystem::path scenes = std::filesystem::path(MONTELUX_SHARED_DIR) / "scenes";
    if (!std::filesystem::exists(scenes)) GTEST_SKIP() << "no shared files";
    int gltf = 0, mitsuba = 0, pbrt = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(scenes)) {
        const std::string ending = entry.path().extension().string();
        auto kind = [&] { return file_kind(DiskFiles().read(entry.path(), std::size_t{1} << 30)); };
        if (ending == ".gltf" || ending == ".glb") {
            EXPECT_EQ(kind().format, SceneFormat::gltf) << entry.path();
            ++gltf;
        } else if (ending == ".pbrt") {
            EXPECT_EQ(kind().format, SceneFormat::pbrt) << entry.path();
            ++pbrt;
        } else if (ending == ".xml" && entry.path().stem() == "cbox") {
            EXPECT_EQ(kind().format, SceneFormat::mitsuba) << entry.path();
            ++mitsuba;
        }
    }
    EXPECT_GT(gltf, 5);
    EXPECT_GT(mitsuba, 0);
    EXPECT_GT(pbrt, 10);
}

} // namespace
} // namespace montelux
