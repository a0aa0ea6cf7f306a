#include "test/house/house.h"

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <regex>
#include <sstream>

namespace montelux::house {

namespace {

constexpr const char* test_macros[] = {"TEST", "TEST_F", "TEST_P", "TYPED_TEST"};

std::string without_comments(std::string_view cmake) {
    std::istringstream in{std::string(cmake)};
    std::string text;
    for (std::string line; std::getline(in, line);) text += line.substr(0, line.find('#')) + "\n";
    return text;
}

std::vector<std::string> words(const std::string& text) {
    std::istringstream in(text);
    std::vector<std::string> result;
    for (std::string word; in >> word;) result.push_back(word);
    return result;
}

std::string at(const SourceFile& file, std::size_t line) {
    return file.path + ":" + std::to_string(line) + ": ";
}

bool starts_with_room(std::string_view path, std::string_view room) {
    return path.substr(0, room.size()) == room && path.size() > room.size() && path[room.size()] == '/';
}

// Reports every edge that closes a circle in a graph of names.
std::vector<std::string> circles(const std::map<std::string, std::vector<std::string>>& graph) {
    std::vector<std::string> found, trail;
    std::set<std::string> done;
    std::function<void(const std::string&)> visit = [&](const std::string& node) {
        auto open = std::find(trail.begin(), trail.end(), node);
        if (open != trail.end()) {
            std::string circle;
            for (auto step = open; step != trail.end(); ++step) circle += *step + " -> ";
            found.push_back(circle + node);
            return;
        }
        if (!graph.contains(node) || !done.insert(node).second) return;
        trail.push_back(node);
        for (const std::string& next : graph.at(node)) visit(next);
        trail.pop_back();
    };
    for (const auto& [node, targets] : graph) visit(node);
    return found;
}

} // namespace

std::string RoomTable::room_of(std::string_view path) const {
    std::string best;
    for (const std::string& room : order)
        if (starts_with_room(path, room) && room.size() > best.size()) best = room;
    return best;
}

bool RoomTable::may_include(const std::string& from, const std::string& to) const {
    if (from == to) return true;
    auto row = uses.find(from);
    return row != uses.end() && std::find(row->second.begin(), row->second.end(), to) != row->second.end();
}

RoomTable parse_rooms(std::string_view cmake) {
    const std::string text = without_comments(cmake);
    const std::regex command(R"((set|montelux_room)\s*\(([^)]*)\))");
    std::map<std::string, std::vector<std::string>> variables;
    RoomTable table;
    for (std::sregex_iterator it(text.begin(), text.end(), command), end; it != end; ++it) {
        std::vector<std::string> arguments;
        for (const std::string& word : words((*it)[2])) {
            bool is_variable = word.starts_with("${") && word.ends_with("}");
            std::string name = is_variable ? word.substr(2, word.size() - 3) : "";
            if (variables.contains(name))
                for (const std::string& value : variables[name]) arguments.push_back(value);
            else
                arguments.push_back(word);
        }
        if (arguments.empty()) continue;
        const std::string name = arguments.front();
        arguments.erase(arguments.begin());
        if ((*it)[1] == "set") {
            variables[name] = arguments;
            continue;
        }
        auto first = std::find(arguments.begin(), arguments.end(), "USES");
        auto last = std::find_if(first, arguments.end(),
                                 [](const std::string& a) { return a == "LINKS" || a == "INCLUDES"; });
        if (first != arguments.end()) ++first;
        table.order.push_back(name);
        table.uses[name] = {first, last};
    }
    return table;
}

std::vector<SourceFile> read_sources(const std::filesystem::path& root,
                                     const std::vector<std::string>& folders) {
    std::vector<SourceFile> files;
    for (const std::string& folder : folders) {
        if (!std::filesystem::exists(root / folder)) continue;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
            const auto extension = entry.path().extension();
            if (!entry.is_regular_file() || (extension != ".h" && extension != ".cpp")) continue;
            SourceFile file{std::filesystem::relative(entry.path(), root).generic_string(), {}};
            std::ifstream in(entry.path());
            for (std::string line; std::getline(in, line);) file.lines.push_back(line);
            files.push_back(std::move(file));
        }
    }
    std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.path < b.path; });
    return files;
}

std::vector<Include> includes_of(const SourceFile& file) {
    static const std::regex directive(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
    std::vector<Include> result;
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
        std::smatch match;
        if (file.lines[i].find('#') != std::string::npos &&
            std::regex_search(file.lines[i], match, directive))
            result.push_back({i + 1, match[2], match[1] == "\""});
    }
    return result;
}

std::vector<std::string> wrong_rooms(const RoomTable& rooms, const std::vector<SourceFile>& files) {
    static const std::string library = "montelux/", tests = "test/";
    std::set<std::string> paths;
    for (const SourceFile& file : files) paths.insert(file.path);

    std::vector<std::string> wrong;
    for (const SourceFile& file : files) {
        const bool in_library = file.path.starts_with(library);
        const std::string room = in_library ? rooms.room_of(file.path.substr(library.size()))
                                 : file.path.starts_with(tests)
                                     ? rooms.room_of(file.path.substr(tests.size()))
                                     : "";
        if (in_library && room.empty()) wrong.push_back(at(file, 1) + "lies in no room of CMakeLists.txt");
        for (const Include& include : includes_of(file)) {
            if (!include.target.starts_with(library)) {
                if (in_library && include.quoted)
                    wrong.push_back(
                        at(file, include.line) + "\"" + include.target +
                        "\" is not a path from the root of the repository that starts with montelux/");
                continue;
            }
            const std::string target = rooms.room_of(include.target.substr(library.size()));
            if (target.empty() || !paths.contains(include.target))
                wrong.push_back(at(file, include.line) + "there is no " + include.target);
            else if (in_library && !room.empty() && !rooms.may_include(room, target))
                wrong.push_back(at(file, include.line) + room + " may not include " + target);
            else if (!in_library && room.starts_with("mc/") && !target.starts_with("mc/"))
                wrong.push_back(at(file, include.line) + "the tests of " + room + " know nothing of " +
                                target);
        }
    }
    return wrong;
}

std::vector<std::string> circular_rooms(const RoomTable& rooms) { return circles(rooms.uses); }

std::vector<std::string> circular_headers(const std::vector<SourceFile>& files) {
    std::map<std::string, std::vector<std::string>> graph;
    for (const SourceFile& file : files)
        for (const Include& include : includes_of(file)) graph[file.path].push_back(include.target);
    return circles(graph);
}

std::vector<std::string> fenced_libraries(const std::vector<SourceFile>& files) {
    // A library that one room alone may know, so that replacing it touches one folder.
    struct Fence {
        std::regex header;
        std::string folder;
        std::string also = "-"; // a folder of tests that stands in for what the library hides
    };
    static const std::vector<Fence> fences = {
        {std::regex("^embree[0-9]*/"), "montelux/accel/"},
        {std::regex("^(tbb|oneapi/tbb)/"), "montelux/mc/parallel/"},
        {std::regex("^boost/(?!asio|beast|system)"), "montelux/mc/math/", "bench/"},
        {std::regex("^boost/(asio|beast|system)"), "montelux/view/"},
        {std::regex("^(OpenEXR/|Imf|Imath|png\\.h|jpeglib\\.h|stb_|stb/)"), "montelux/image/"},
        {std::regex("^xxh"), "montelux/scene/"},
        {std::regex("^dlfcn\\.h$"), "montelux/mc/io/", "test/"},
        {std::regex("^mpi\\.h$"), "montelux/cluster/"},
        {std::regex("^nanovdb/"), "montelux/formats/", "test/"},
        {std::regex("^CLI/"), "app/"},
    };
    std::vector<std::string> wrong;
    for (const SourceFile& file : files)
        for (const Include& include : includes_of(file))
            for (const Fence& fence : fences)
                if (std::regex_search(include.target, fence.header) && !file.path.starts_with(fence.folder) &&
                    !file.path.starts_with(fence.also) &&
                    !file.path.starts_with("test/" + fence.folder.substr(fence.folder.find('/') + 1)))
                    wrong.push_back(at(file, include.line) + include.target + " is known to " + fence.folder +
                                    " alone");
    return wrong;
}

std::vector<std::string> headers_without_purpose(const std::vector<SourceFile>& files) {
    static const std::regex sentence(R"(^// \S+ \S+)");
    std::vector<std::string> wrong;
    for (const SourceFile& file : files)
        if (file.path.ends_with(".h") &&
            (file.lines.empty() || !std::regex_search(file.lines.front(), sentence)))
            wrong.push_back(at(file, 1) + "the first line does not say what the header is for");
    return wrong;
}

std::vector<std::string> misplaced_headers(const std::vector<SourceFile>& files, const std::string& folder) {
    auto is_top = [&](const std::string& path) {
        return path.starts_with(folder) && path.find('/', folder.size()) == path.npos;
    };
    std::map<std::string, std::set<std::string>> users; // folders of a header's users in the library
    for (const SourceFile& file : files) {
        if (!file.path.starts_with("montelux/")) continue;
        const std::string stem = file.path.substr(0, file.path.rfind('.'));
        for (const Include& include : includes_of(file))
            if (is_top(include.target) && include.target != stem + ".h")
                users[include.target].insert(file.path.substr(0, file.path.rfind('/') + 1));
    }
    std::vector<std::string> wrong;
    for (const SourceFile& file : files) {
        const auto of = users.find(file.path);
        if (of == users.end() || of->second.size() != 1) continue;
        const std::string& only = *of->second.begin();
        if (only != folder && only.starts_with(folder))
            wrong.push_back(at(file, 1) + "is used in " + only + " alone");
    }
    return wrong;
}

std::vector<std::string> long_files(const std::vector<SourceFile>& files, std::size_t limit) {
    std::vector<std::string> wrong;
    for (const SourceFile& file : files)
        if (file.lines.size() > limit && file.path.find("_data.") == std::string::npos)
            wrong.push_back(at(file, limit) + std::to_string(file.lines.size()) + " lines, and " +
                            std::to_string(limit) + " are allowed");
    return wrong;
}

namespace {

// Without white space, so that a macro can be found however it is broken into lines.
std::string dense_text(const SourceFile& file) {
    std::string text;
    for (const std::string& line : file.lines)
        std::copy_if(line.begin(), line.end(), std::back_inserter(text), [](char c) { return c != ' '; });
    return text;
}

bool has_test(const std::string& text, const std::string& prefix, const std::string& suite,
              const std::string& name) {
    if (!prefix.empty() && text.find("INSTANTIATE_TEST_SUITE_P(" + prefix + "," + suite + ",") == text.npos)
        return false;
    const std::string call = "(" + suite + "," + (name == "*" ? "" : name + ")");
    return std::any_of(std::begin(test_macros), std::end(test_macros),
                       [&](const char* macro) { return text.find(macro + call) != text.npos; });
}

} // namespace

std::vector<std::string> missing_paths(const SourceFile& page, const std::filesystem::path& root) {
    static const std::regex path("`([\\w.-]+(?:/[\\w.-]+)*/[\\w-]+\\.(?:h|cpp|py|sh|txt|cmake)|[\\w./-]+/)`");
    std::vector<std::string> wrong;
    for (std::size_t i = 0; i < page.lines.size(); ++i) {
        const std::string& line = page.lines[i];
        for (std::sregex_iterator q(line.begin(), line.end(), path), end; q != end; ++q) {
            const std::string name = (*q)[1];
            if (name.find("NAME") != name.npos || std::filesystem::exists(root / name) ||
                std::filesystem::exists(root / "montelux" / name) ||
                std::filesystem::exists(root / "montelux/mc/integrate" / name))
                continue;
            wrong.push_back(at(page, i + 1) + "there is no " + name);
        }
    }
    return wrong;
}

std::vector<std::string> missing_names(const SourceFile& page, const std::vector<SourceFile>& files) {
    static const std::regex quoted("`([^`]+)`");
    static const std::regex file_name(R"([\w./]+\.(h|cpp))");
    static const std::regex test_name(R"((?:(\w+)/)?(\w*)\.(\w+|\*)(?:/.*)?)");
    std::vector<std::string> wrong;
    for (std::size_t i = 0; i < page.lines.size(); ++i) {
        std::string text, suite;
        bool in_file = false;
        const std::string& line = page.lines[i];
        for (std::sregex_iterator q(line.begin(), line.end(), quoted), end; q != end; ++q) {
            const std::string name = (*q)[1];
            std::smatch part;
            if (std::regex_match(name, file_name)) {
                const std::string path = (name.ends_with(".h") ? "montelux/" : "test/") + name;
                auto file = std::find_if(files.begin(), files.end(),
                                         [&](const SourceFile& f) { return f.path == path; });
                in_file = file != files.end() && name.ends_with(".cpp");
                if (file == files.end()) wrong.push_back(at(page, i + 1) + "there is no " + path);
                text = in_file ? dense_text(*file) : "";
            } else if (in_file && std::regex_match(name, part, test_name)) {
                if (part[2].length() > 0) suite = part[2];
                if (!has_test(text, part[1], suite, part[3]))
                    wrong.push_back(at(page, i + 1) + "there is no test " + name);
            }
        }
    }
    return wrong;
}

} // namespace montelux::house
