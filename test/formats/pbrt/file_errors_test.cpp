// Error messages of broken files and of files in files: the place and the sentence.
#include "test/formats/pbrt/parse.h"
#include "test/temporary_folder.h"
#include <filesystem>
#include <gtest/gtest.h>
#include <string>

namespace montelux {
namespace {

using test::error_of;

TEST(PbrtErrors, BinaryGarbageAndNulBytes) {
    EXPECT_EQ(error_of(std::string("WorldBegin\n \0x", 14)),
              "scene:2:2: a NUL byte; expected text (is this a binary file?)");
    EXPECT_EQ(error_of(std::string("WorldBegin\nShape \"a\0b\"", 22)), "scene:2:9: a NUL byte in a string");
    EXPECT_EQ(error_of("\xff\xfeW"), "scene:1:1: the file is in UTF-16; expected ASCII or UTF-8 text");
    EXPECT_EQ(error_of("\xef\xbb\xbfWorldBegin"), ""); // a byte order mark of UTF-8 does no harm
}

std::string load_error(const std::filesystem::path& path) {
    Warnings warnings;
    try {
        load_pbrt(path, warnings);
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}

TEST(PbrtErrors, PlacesInIncludedFiles) {
    TemporaryFolder folder;
    auto main = folder.write("main.pbrt", "WorldBegin\nInclude \"part.pbrt\"\n");
    auto part = folder.write("part.pbrt", "Shape \"sphere\"\n  Shape \"cube\"\n");
    EXPECT_EQ(load_error(main), part.string() + ":2:3: unknown shape 'cube' (did you mean 'curve'?)");
}

TEST(PbrtErrors, FilesThatIncludeThemselves) {
    TemporaryFolder folder;
    auto main = folder.write("main.pbrt", "WorldBegin\nInclude \"a.pbrt\"\n");
    auto a = folder.write("a.pbrt", "\nImport \"b.pbrt\"");
    auto b = folder.write("b.pbrt", "Include \"./main.pbrt\"");
    EXPECT_EQ(load_error(main),
              b.string() + ":1:1: '" + (main.parent_path() / "./main.pbrt").string() + "' includes itself");
    for (int i = 0; i < 70; ++i)
        folder.write("deep" + std::to_string(i), "Include \"deep" + std::to_string(i + 1) + "\"");
    auto deep = folder.write("deep.pbrt", "WorldBegin Include \"deep0\"");
    EXPECT_NE(load_error(deep).find("files are nested more than 64 levels deep"), std::string::npos);
}

TEST(PbrtErrors, BlocksAcrossImports) {
    TemporaryFolder folder;
    auto open = folder.write("open.pbrt", "AttributeBegin");
    folder.write("close.pbrt", "AttributeEnd");
    EXPECT_EQ(load_error(folder.write("a.pbrt", "WorldBegin Import \"open.pbrt\"")),
              open.string() + ":1:1: this block is not closed in the imported file");
    EXPECT_NE(load_error(folder.write("b.pbrt", "WorldBegin AttributeBegin Import \"close.pbrt\""))
                  .find("close.pbrt:1:1: AttributeEnd without AttributeBegin"),
              std::string::npos);
    EXPECT_EQ(load_error(folder.write("c.pbrt", "WorldBegin Include \"open.pbrt\" Include \"close.pbrt\"")),
              "");
}

TEST(PbrtErrors, DamagedMeshesAndFoldersAsFiles) {
    TemporaryFolder folder;
    auto mesh = folder.write("mesh.ply", "ply\nformat ascii 1.0\nend_header\n");
    auto main = folder.write("main.pbrt", "WorldBegin\nShape \"plymesh\" \"string filename\" \"mesh.ply\"");
    EXPECT_EQ(load_error(main),
              main.string() + ":2:17: " + mesh.string() + ": the file has no element 'vertex'");
    EXPECT_NE(load_error(main.parent_path()), "");
    EXPECT_NE(load_error(main.parent_path() / "none.pbrt"), "");
    auto packed = folder.write("main.pbrt.gz", "this is not gzip");
    EXPECT_NE(load_error(packed).find("gzip data is damaged"), std::string::npos);
}

} // namespace
} // namespace montelux
