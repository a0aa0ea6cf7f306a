#include "test/house/house.h"
#include <fstream>
#include <gtest/gtest.h>
#include <iostream>
#include <sstream>

namespace montelux::house {
namespace {

const std::filesystem::path root = MONTELUX_SOURCE_DIR;
const std::vector<std::string> folders = {"montelux", "app", "python", "test", "bench", "examples"};

RoomTable real_rooms() {
    std::ifstream in(root / "CMakeLists.txt");
    std::ostringstream text;
    text << in.rdbuf();
    return parse_rooms(text.str());
}
const std::vector<SourceFile>& real_sources() {
    static const std::vector<SourceFile> files = read_sources(root, folders);
    return files;
}
std::string joined(const std::vector<std::string>& sentences) {
    std::string text;
    for (const std::string& s : sentences) text += s + "\n";
    return text;
}

TEST(House, TableOfRoomsIsRead) {
    const RoomTable rooms = real_rooms();
    EXPECT_GE(rooms.order.size(), 14u);
    EXPECT_TRUE(rooms.uses.at("mc/math").empty());
    EXPECT_TRUE(rooms.may_include("transport", "accel"));
    EXPECT_TRUE(rooms.may_include("scene", "mc/dist")); // by way of a variable of the table
    EXPECT_FALSE(rooms.may_include("scene", "accel"));
    EXPECT_EQ(rooms.room_of("mc/math/vec.h"), "mc/math");
    EXPECT_GE(real_sources().size(), 30u);
}
TEST(House, EachFileIncludesOnlyWhatItsRoomMay) {
    EXPECT_EQ(joined(wrong_rooms(real_rooms(), real_sources())), "");
}
TEST(House, NoCircles) {
    EXPECT_EQ(joined(circular_rooms(real_rooms())), "");
    EXPECT_EQ(joined(circular_headers(real_sources())), "");
}
TEST(House, LibrariesStayBehindTheirFences) { EXPECT_EQ(joined(fenced_libraries(real_sources())), ""); }
TEST(House, EachHeaderSaysItsPurposeFirst) { EXPECT_EQ(joined(headers_without_purpose(real_sources())), ""); }
TEST(House, EachFileIncludesWhatItNames) {
    for (const char* folder : {"montelux/", "app/"})
        EXPECT_EQ(joined(missing_includes(real_sources(), folder)), "");
}
TEST(House, WhatOneMethodUsesLiesInItsFolder) {
    EXPECT_EQ(joined(misplaced_headers(real_sources(), "montelux/mc/integrate/")), "");
}
TEST(House, FilesAreShort) {
    std::cout << "longer than they should be:\n" << joined(long_files(real_sources(), 400));
    EXPECT_EQ(joined(long_files(real_sources(), 600)), "");
}
SourceFile real_page(const std::string& path) { return read_page(path, root); }
std::vector<SourceFile> real_pages() {
    std::vector<SourceFile> pages{real_page("README.md")};
    for (const char* folder : {"docs", "examples"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder))
            if (entry.path().extension() == ".md")
                pages.push_back(real_page(std::filesystem::relative(entry.path(), root).generic_string()));
    return pages;
}
TEST(House, TheArchitectureNamesFilesThatExist) {
    const SourceFile page = real_page("docs/architecture.md");
    EXPECT_GE(page.lines.size(), 80u);
    EXPECT_EQ(joined(missing_paths(page, root)), "");
}
TEST(House, TheMissionNamesTestsThatExist) {
    const SourceFile page = real_page("docs/mission.md");
    EXPECT_GE(page.lines.size(), 30u);
    EXPECT_EQ(joined(missing_names(page, real_sources())), "");
}
TEST(House, LinksOfPagesLeadSomewhere) {
    EXPECT_GE(real_pages().size(), 20u);
    EXPECT_EQ(joined(broken_links(real_pages(), root)), "");
}

// The rules themselves: each finds the offence that it exists for.
const RoomTable small = parse_rooms("set(low mc/math) # a comment (with brackets\n"
                                    "montelux_room(mc/math)\n"
                                    "montelux_room(scene USES ${low} LINKS a::b)\n"
                                    "montelux_room(accel USES ${low}\n  scene LINKS embree)\n");
const SourceFile math{"montelux/mc/math/vec.h", {"// Vectors of three."}};
const SourceFile accel{"montelux/accel/ray.h", {"// Rays and hits.", "#include <embree3/rtcore.h>"}};

TEST(HouseRules, TableExpandsVariablesAndStopsAtLinks) {
    EXPECT_EQ(small.order, (std::vector<std::string>{"mc/math", "scene", "accel"}));
    EXPECT_EQ(small.uses.at("scene"), (std::vector<std::string>{"mc/math"}));
    EXPECT_EQ(small.uses.at("accel"), (std::vector<std::string>{"mc/math", "scene"}));
}
TEST(HouseRules, IncludeOfAHigherRoomIsFound) {
    const SourceFile wrong{"montelux/scene/x.cpp", {"", "#include \"montelux/accel/ray.h\""}};
    EXPECT_EQ(joined(wrong_rooms(small, {math, accel, wrong})),
              "montelux/scene/x.cpp:2: scene may not include accel\n");
    const SourceFile right{"montelux/accel/x.cpp", {"#include \"montelux/mc/math/vec.h\""}};
    EXPECT_EQ(joined(wrong_rooms(small, {math, accel, right})), "");
}
TEST(HouseRules, StrayFilesAndPathsAreFound) {
    EXPECT_EQ(wrong_rooms(small, {SourceFile{"montelux/attic/x.cpp", {}}}).size(), 1u);
    EXPECT_EQ(wrong_rooms(small, {SourceFile{"montelux/scene/x.cpp", {"#include \"y.h\""}}}).size(), 1u);
    EXPECT_EQ(
        wrong_rooms(small, {SourceFile{"montelux/scene/x.cpp", {"#include \"montelux/scene/no.h\""}}}).size(),
        1u);
    EXPECT_EQ(wrong_rooms(small, {SourceFile{"montelux/scene/x.cpp", {"#include \"app/y.h\""}}}).size(), 1u);
    EXPECT_EQ(
        wrong_rooms(small, {accel, SourceFile{"test/mc/math/x.cpp", {"#include \"montelux/accel/ray.h\""}}})
            .size(),
        1u);
}
TEST(HouseRules, CirclesAreFound) {
    EXPECT_EQ(joined(circular_rooms(parse_rooms("montelux_room(a USES b)\nmontelux_room(b USES c)\n"
                                                "montelux_room(c USES a)"))),
              "a -> b -> c -> a\n");
    EXPECT_EQ(circular_headers({{"montelux/a.h", {"#include \"montelux/b.h\""}},
                                {"montelux/b.h", {"  #  include \"montelux/a.h\""}}})
                  .size(),
              1u);
    EXPECT_TRUE(
        circular_headers({{"montelux/a.h", {"#include \"montelux/b.h\""}}, {"montelux/b.h", {}}}).empty());
}
TEST(HouseRules, EmbreeOutsideAccelIsFound) {
    EXPECT_TRUE(fenced_libraries({accel}).empty());
    EXPECT_EQ(fenced_libraries({{"montelux/transport/x.cpp", {"#include <embree4/rtcore.h>"}}}).size(), 1u);
    EXPECT_EQ(fenced_libraries({{"montelux/render/x.cpp", {"#include <tbb/parallel_for.h>"}}}).size(), 1u);
    EXPECT_EQ(fenced_libraries({{"montelux/render/x.cpp", {"#include <dlfcn.h>"}}}).size(), 1u);
}
TEST(HouseRules, HeaderWithoutPurposeIsFound) {
    EXPECT_TRUE(headers_without_purpose({math}).empty());
    EXPECT_EQ(headers_without_purpose({{"montelux/mc/math/x.h", {"#pragma once"}}}).size(), 1u);
    EXPECT_EQ(headers_without_purpose({{"montelux/mc/math/x.h", {}}}).size(), 1u);
}
TEST(HouseRules, NamesWithoutTheirHeaderAreFound) {
    const SourceFile names{"montelux/a/x.h",
                           {"// Bytes.", "std::size_t vector_bytes(int n);", "struct Tree {};"}};
    const SourceFile between{"montelux/a/y.h", {"#include \"montelux/a/x.h\""}};
    const auto offences = [&](std::vector<std::string> lines) {
        return joined(
            missing_includes({names, between, {"montelux/a/z.cpp", std::move(lines)}}, "montelux/"));
    };
    EXPECT_EQ(offences({"", "int n = vector_bytes(1);"}),
              "montelux/a/z.cpp:2: vector_bytes needs #include \"montelux/a/x.h\"\n");
    EXPECT_EQ(offences({"void grow(const Tree&);"}),
              "montelux/a/z.cpp:1: Tree needs #include \"montelux/a/x.h\"\n");
    EXPECT_EQ(offences({"#include \"montelux/a/y.h\"", "int n = vector_bytes(1); Tree t;"}), "");
    EXPECT_EQ(offences({"struct Tree;", "void grow(const Tree&);"}), "");
    EXPECT_EQ(offences({"// vector_bytes(1)", "f(\"Tree\"); x.vector_bytes(1); other::vector_bytes(1);"}),
              "");
}
TEST(HouseRules, HeaderOfOneSubfolderIsFound) {
    const SourceFile header{"montelux/a/x.h", {}}, own{"montelux/a/x.cpp", {"#include \"montelux/a/x.h\""}};
    const SourceFile deep{"montelux/a/b/y.cpp", {"#include \"montelux/a/x.h\""}};
    const SourceFile beside{"montelux/a/z.cpp", deep.lines}, other{"montelux/a/c/y.cpp", deep.lines};
    EXPECT_EQ(joined(misplaced_headers({header, own, deep}, "montelux/a/")),
              "montelux/a/x.h:1: is used in montelux/a/b/ alone\n");
    EXPECT_TRUE(misplaced_headers({header, own, deep, beside}, "montelux/a/").empty());
    EXPECT_TRUE(misplaced_headers({header, own, deep, other}, "montelux/a/").empty());
    EXPECT_TRUE(misplaced_headers({header, own}, "montelux/a/").empty());
}
TEST(HouseRules, LongFileIsFound) {
    const SourceFile file{"montelux/scene/x.cpp", std::vector<std::string>(11)};
    EXPECT_EQ(long_files({file}, 10).size(), 1u);
    EXPECT_TRUE(long_files({file}, 11).empty());
    EXPECT_TRUE(long_files({{"montelux/spectrum/cie_data.cpp", file.lines}}, 10).empty());
}
TEST(HouseRules, MissingPathsAreFound) {
    auto wrong = [&](const std::string& line) { return joined(missing_paths({"docs/a.md", {line}}, root)); };
    EXPECT_EQ(
        wrong("`montelux/mc/math/vec.h`, `mc/math/vec.h`, `test/house/`, `montelux/scene/NAME.h`, `a / b`"),
        "");
    EXPECT_EQ(wrong("`test/house/`, `montelux/mc/math/none.h`"),
              "docs/a.md:1: there is no montelux/mc/math/none.h\n");
    EXPECT_EQ(wrong("`test/attic/`"), "docs/a.md:1: there is no test/attic/\n");
}
TEST(HouseRules, MissingTestsAndFilesAreFound) {
    const SourceFile tests{"test/mc/math/vec_test.cpp",
                           {"TEST(Vec, Adds) {}", "TEST_P(Each,", "       Holds) {}",
                            "INSTANTIATE_TEST_SUITE_P(All, Each, x);"}};
    auto wrong = [&](const std::string& line) {
        return joined(missing_names({"docs/a.md", {"", line}}, {math, tests}));
    };
    EXPECT_EQ(wrong("`sin x` by `mc/math/vec.h`, in `mc/math/vec_test.cpp`: `Vec.Adds`, `Each.*`, `.Holds`, "
                    "`All/Each.Holds/Long` and `x = 0.5`"),
              "");
    EXPECT_EQ(wrong("`mc/math/vec_test.cpp`: `Vec.Add`"), "docs/a.md:2: there is no test Vec.Add\n");
    EXPECT_EQ(wrong("`mc/math/vec_test.cpp`: `Vek.*`"), "docs/a.md:2: there is no test Vek.*\n");
    EXPECT_EQ(wrong("`mc/math/vec_test.cpp`: `Vec.Adds`, `.Holds`"),
              "docs/a.md:2: there is no test .Holds\n");
    EXPECT_EQ(wrong("`mc/math/vec_test.cpp`: `Some/Each.*`"), "docs/a.md:2: there is no test Some/Each.*\n");
    EXPECT_EQ(wrong("`mc/math/no_test.cpp`, `mc/math/no.h`"),
              "docs/a.md:2: there is no test/mc/math/no_test.cpp\ndocs/a.md:2: there is no "
              "montelux/mc/math/no.h\n");
}
TEST(HouseRules, BrokenLinksAreFound) {
    auto wrong = [&](const std::vector<std::string>& lines) {
        return joined(broken_links({{"docs/a.md", lines}}, root));
    };
    EXPECT_EQ(wrong({"# One, `two`: [3](a:b) 4",
                     "[a](../README.md#licence), ![b](images/demo.png) [c](#one-two-3-4)",
                     "[d](https://a.b/c), `[e](none.md)`", "```", "[f](none.md)", "# g", "```"}),
              "");
    EXPECT_EQ(wrong({"see [a](none.md), ![b](../docs/images/none.png)"}),
              "docs/a.md:1: there is no docs/none.md\ndocs/a.md:1: there is no docs/images/none.png\n");
    EXPECT_EQ(
        wrong({"# Here", "[a](#there), [b](../README.md#none)"}),
        "docs/a.md:2: there is no heading #there\ndocs/a.md:2: there is no heading ../README.md#none\n");
}

} // namespace
} // namespace montelux::house
