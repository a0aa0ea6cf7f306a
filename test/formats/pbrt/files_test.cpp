// The files of a scene: digest, compressed text, imports.
#include "test/formats/gzip.h"
#include "test/formats/pbrt/parse.h"
#include "test/near.h"
#include "test/temporary_folder.h"
#include <filesystem>
#include <gtest/gtest.h>
#include <string>

#include "montelux/image/image_write.h"
#include "montelux/scene/scene_digest.h"

namespace montelux {
namespace {

class PbrtFolder : public ::testing::Test {
  protected:
    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        return folder_.write(name, bytes);
    }
    static SceneDescription load(const std::filesystem::path& path) {
        Warnings warnings;
        return load_pbrt(path, warnings);
    }
    static std::string load_error(const std::filesystem::path& path) {
        try {
            load(path);
        } catch (const Error& e) {
            return e.what();
        }
        return {};
    }

    TemporaryFolder folder_;
};

std::string text_of(const std::vector<std::uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

// A square picture in the format PFM, whose bytes are the numbers themselves.
std::string pfm(int size) {
    std::string bytes = "PF\n" + std::to_string(size) + " " + std::to_string(size) + "\n-1\n";
    for (int i = 0; i < 3 * size * size; ++i) bytes += std::string("\0\0\x80\x3f", 4);
    return bytes;
}

// What a file says counts, and not how it says it.
TEST_F(PbrtFolder, TheDigestCoversEveryKindOfFile) {
    const std::string ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                            "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                            "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2";
    auto main = write("main.pbrt", R"(WorldBegin
        LightSource "infinite" "string filename" "sky.pfm"
        Texture "t" "spectrum" "imagemap" "string filename" "picture.pfm"
        Material "conductor" "texture reflectance" "t"
        Shape "plymesh" "string filename" "mesh.ply"
        Shape "plymesh" "string filename" "packed.ply.gz"
        Include "part.pbrt"
        Import "part.pbrt.gz")");
    struct File {
        std::string name, bytes, other_value, same_values;
    };
    auto packed = [](const std::string& text) { return text_of(gzip(text)); };
    auto replaced = [](std::string text, const std::string& from, const std::string& to) {
        return text.replace(text.find(from), from.size(), to);
    };
    auto other_pixel = [](std::string bytes) {
        bytes[bytes.size() - 3] = 1;
        return bytes;
    };
    const std::string spd = "400 0.5 700 0.5", disk = "Shape \"disk\"";
    const std::string part = "Material \"diffuse\" \"spectrum reflectance\" \"grey.spd\" ";
    const std::string wider = replaced(ply, "\n1 0 0", "\n2 0 0");
    const std::string comment = replaced(ply, "element", "comment made anew\nelement");
    const File files[] = {
        {"sky.pfm", pfm(8), other_pixel(pfm(8)), replaced(pfm(8), "\n-1\n", "\n-1.0\n")},
        {"picture.pfm", pfm(4), other_pixel(pfm(4)), replaced(pfm(4), "\n-1\n", "\n-1.0\n")},
        {"mesh.ply", ply, wider, comment},
        {"packed.ply.gz", packed(ply), packed(wider), packed(comment)},
        {"part.pbrt", part, "Material \"diffuse\" ", part + "# the floor\n"},
        {"part.pbrt.gz", packed(disk), packed(disk + " \"float radius\" 2"), packed("# a disk\n" + disk)},
        {"grey.spd", spd, "400 0.5 700 0.6", "# grey\n" + spd}};
    for (const File& f : files) write(f.name, f.bytes);
    auto digest = [&] { return digest_of(load(main).scene); };
    const SceneDigest before = digest();
    for (const File& f : files) {
        write(f.name, f.other_value);
        EXPECT_NE(digest(), before) << f.name;
        write(f.name, f.same_values);
        EXPECT_EQ(digest(), before) << f.name;
        write(f.name, f.bytes);
    }
}

TEST_F(PbrtFolder, TextThatUnpacksOutOfProportionIsRefused) {
    const std::vector<std::uint8_t> packed = gzip("WorldBegin\n" + std::string(std::size_t{64} << 20, ' '));
    auto bomb = write("bomb.pbrt.gz", text_of(packed));
    const std::string sentence = bomb.string() +
                                 ": unpacks to more than 16 MiB, which is out of proportion to its " +
                                 std::to_string(packed.size()) + " bytes";
    EXPECT_EQ(load_error(bomb), sentence);
    auto main = write("main.pbrt", "WorldBegin Include \"bomb.pbrt.gz\"");
    EXPECT_EQ(load_error(main), main.string() + ":1:12: " + sentence);
}

// X, Y and Z are no grey picture, though there is a Y.
// Scenes written on Windows.
TEST_F(PbrtFolder, BackslashesMaySeparateFolders) {
    std::filesystem::create_directory(folder_ / "sub");
    write_image(folder_ / "sub/map.exr", Image(2, 2, {"R", "G", "B"}));
    Warnings warnings;
    const auto load = [&](const std::string& name) {
        return parse_pbrt("WorldBegin LightSource \"infinite\" \"string filename\" \"" + name + "\"", "scene",
                          folder_.path(), warnings);
    };
    EXPECT_EQ(load("sub\\\\map.exr").scene.lights.size(), 1u);
    write_image(folder_ / "sub\\map.exr", Image(4, 4, {"R", "G", "B"})); // its very name comes first
    EXPECT_EQ(load("sub\\\\map.exr").scene.environments.at(0).width(), 4);
}

TEST_F(PbrtFolder, PicturesInXyzAreRefused) {
    Image picture(8, 8, {"X", "Y", "Z"});
    for (float& v : picture.f32()) v = 0.5f;
    write_image(folder_ / "xyz.exr", picture);
    for (const char* world : {"LightSource \"infinite\" \"string filename\" \"xyz.exr\"",
                              "Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"xyz.exr\" "
                              "Shape \"sphere\" \"texture alpha\" \"t\""})
        EXPECT_NE(load_error(write("main.pbrt", std::string("WorldBegin ") + world))
                      .find("has neither channels R, G and B nor Y"),
                  std::string::npos)
            << world;
}

// pbrt reads an imported file with a table of names of its own.
TEST_F(PbrtFolder, CoordinateSystemsOfAnImportedFileEndWithIt) {
    write("inner.pbrt", "Translate 0 0 5 CoordinateSystem \"a\" CoordinateSystem \"c\"");
    write("part.pbrt", R"(CoordSysTransform "b" Shape "sphere"
        Translate 0 7 0 CoordinateSystem "a" CoordinateSystem "only here" Import "inner.pbrt"
        CoordSysTransform "a" Shape "sphere")");
    const std::string text = "WorldBegin Translate 1 0 0 CoordinateSystem \"a\" Translate 2 0 0\n"
                             "CoordinateSystem \"b\" Identity Import \"part.pbrt\"\n";
    SceneDescription d = load(write("main.pbrt", text + "CoordSysTransform \"a\" Shape \"sphere\""));
    const Vec3f centers[] = {{3, 0, 0}, {3, 7, 0}, {1, 0, 0}};
    ASSERT_EQ(d.scene.quadrics.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i)
        expect_near(std::get<Sphere>(d.scene.quadrics[i]).world_from_object.point(Vec3f()), centers[i]);
    for (const char* name : {"only here", "c"}) {
        auto main = write("main.pbrt", text + "CoordSysTransform \"" + name + "\"");
        EXPECT_EQ(load_error(main),
                  main.string() + ":3:1: there is no coordinate system '" + std::string(name) + "'");
    }
    auto included = write("main.pbrt", "WorldBegin CoordinateSystem \"b\" Include \"part.pbrt\"\n"
                                       "CoordSysTransform \"only here\"");
    EXPECT_EQ(load_error(included), "");
}

} // namespace
} // namespace montelux
