// The table of rooms in CMakeLists.txt, and the rules for all source files.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace montelux::house {

// Maps a room to the rooms that it may include, in the order of declaration.
struct RoomTable {
    std::vector<std::string> order;
    std::map<std::string, std::vector<std::string>> uses;

    // The room of a path below montelux/ (the longest name that fits); empty if there is none.
    std::string room_of(std::string_view path) const;
    bool may_include(const std::string& from, const std::string& to) const;
};

// Reads the montelux_room(...) commands; set(name values...) before them is expanded in ${name}.
RoomTable parse_rooms(std::string_view cmake);

struct SourceFile {
    std::string path; // relative to the root of the repository, with '/'
    std::vector<std::string> lines;
};
// The .h and .cpp files below these folders of `root`, in alphabetical order.
std::vector<SourceFile> read_sources(const std::filesystem::path& root,
                                     const std::vector<std::string>& folders);

struct Include {
    std::size_t line = 0; // from 1
    std::string target;
    bool quoted = false;
};
std::vector<Include> includes_of(const SourceFile& file);

// Each returns one sentence per offence, "path:line: ...", and nothing if there is none.
std::vector<std::string> wrong_rooms(const RoomTable& rooms, const std::vector<SourceFile>& files);
std::vector<std::string> circular_rooms(const RoomTable& rooms);
std::vector<std::string> circular_headers(const std::vector<SourceFile>& files);
std::vector<std::string> fenced_libraries(const std::vector<SourceFile>& files);
std::vector<std::string> headers_without_purpose(const std::vector<SourceFile>& files);
// Names of types and functions that a file below `folder` uses without including, directly or by way of other headers,
// any header there that declares them. Builds that compile several files as one do not notice.
std::vector<std::string> missing_includes(const std::vector<SourceFile>& files, std::string_view folder);
// Headers at the top of a folder that only files of one of its subfolders include: they belong there.
std::vector<std::string> misplaced_headers(const std::vector<SourceFile>& files, const std::string& folder);
// Files of more than `limit` lines, except tables of measured data (*_data.*, *_table_data.*).
std::vector<std::string> long_files(const std::vector<SourceFile>& files, std::size_t limit);
// Paths of files in `backticks` on a page, from the root or below montelux/, that do not exist; a path with
// NAME in it is a pattern.
std::vector<std::string> missing_paths(const SourceFile& page, const std::filesystem::path& root);
// Names in `backticks` on a page that do not exist among these files: headers (`mc/a/b.h` below montelux/),
// test files (`mc/a/b_test.cpp` below test/), and after such a file, until the end of the line, its tests:
// `Suite.Name`, `Suite.*`, `.Name` of the suite before, `Prefix/Suite.Name/...`.
std::vector<std::string> missing_names(const SourceFile& page, const std::vector<SourceFile>& files);
SourceFile read_page(const std::string& path, const std::filesystem::path& root);
// Broken links and pictures of these Markdown pages, [text](target): a path (relative to the page) without a
// file below `root`, or a #heading that the page does not have. Ignores addresses with a scheme, and code.
std::vector<std::string> broken_links(const std::vector<SourceFile>& pages,
                                      const std::filesystem::path& root);

} // namespace montelux::house
