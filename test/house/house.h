// The table of rooms as CMakeLists.txt states it, and the rules that every source file is held to.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace montelux::house {

// From a room to the rooms that it may include, in the order of declaration.
struct RoomTable {
    std::vector<std::string> order;
    std::map<std::string, std::vector<std::string>> uses;

    // The room that a path below montelux/ lies in (the longest name that fits); empty where there is none.
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

// Each returns one sentence for each offence, "path:line: ...", and nothing for a house in order.
std::vector<std::string> wrong_rooms(const RoomTable& rooms, const std::vector<SourceFile>& files);
std::vector<std::string> circular_rooms(const RoomTable& rooms);
std::vector<std::string> circular_headers(const std::vector<SourceFile>& files);
std::vector<std::string> fenced_libraries(const std::vector<SourceFile>& files);
std::vector<std::string> headers_without_purpose(const std::vector<SourceFile>& files);
// Headers at the top of a folder that files of one of its subfolders alone include: they belong there.
std::vector<std::string> misplaced_headers(const std::vector<SourceFile>& files, const std::string& folder);
// Files of more than `limit` lines; tables of measured data (*_data.*, *_table_data.*) are left out.
std::vector<std::string> long_files(const std::vector<SourceFile>& files, std::size_t limit);
// Paths of files in `backticks` on a page, from the root or below montelux/, of which there is no file; a path
// with NAME in it is a pattern.
std::vector<std::string> missing_paths(const SourceFile& page, const std::filesystem::path& root);
// What a page of documentation names in `backticks` but does not exist among these files: headers (`mc/a/b.h`
// below montelux/), test files (`mc/a/b_test.cpp` below test/), and behind such a file, until the end of the
// line, its tests: `Suite.Name`, `Suite.*`, `.Name` of the suite before, `Prefix/Suite.Name/...`.
std::vector<std::string> missing_names(const SourceFile& page, const std::vector<SourceFile>& files);
SourceFile read_page(const std::string& path, const std::filesystem::path& root);
// Links and pictures of these Markdown pages, [text](target), that lead nowhere: a path (relative to the page) of
// which there is no file below `root`, or a #heading that the page does not have. Addresses with a scheme and what
// stands in code are left out.
std::vector<std::string> broken_links(const std::vector<SourceFile>& pages,
                                      const std::filesystem::path& root);

} // namespace montelux::house
