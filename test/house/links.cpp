#include "test/house/house.h"
#include <cctype>
#include <fstream>
#include <regex>

namespace montelux::house {

namespace {

// Lines outside of ``` blocks, without `code`.
std::vector<std::string> prose_of(const std::vector<std::string>& lines) {
    static const std::regex code("`[^`]*`");
    std::vector<std::string> prose;
    bool in_block = false;
    for (const std::string& line : lines) {
        const bool fence = line.starts_with("```");
        prose.push_back(fence || in_block ? "" : std::regex_replace(line, code, ""));
        if (fence) in_block = !in_block;
    }
    return prose;
}

// The name of a heading in addresses, as GitHub and other sites make it.
std::string anchor(const std::string& heading) {
    std::string name;
    for (const unsigned char c : heading)
        if (c == ' ')
            name += '-';
        else if (std::isalnum(c) || c == '-' || c == '_')
            name += char(std::tolower(c));
    return name;
}

std::set<std::string> anchors_of(const std::vector<std::string>& lines) {
    static const std::regex heading("^#+ +(.*?) *$"), link(R"(\[([^\]]*)\]\([^)]*\))");
    std::set<std::string> names;
    bool in_block = false;
    for (const std::string& line : lines) {
        if (line.starts_with("```")) in_block = !in_block;
        std::smatch match;
        if (!in_block && std::regex_match(line, match, heading))
            names.insert(anchor(std::regex_replace(match[1].str(), link, "$1")));
    }
    return names;
}

} // namespace

SourceFile read_page(const std::string& path, const std::filesystem::path& root) {
    SourceFile page{path, {}};
    std::ifstream in(root / path);
    for (std::string line; std::getline(in, line);) page.lines.push_back(line);
    return page;
}

std::vector<std::string> broken_links(const std::vector<SourceFile>& pages,
                                      const std::filesystem::path& root) {
    static const std::regex link(R"(\]\(([^)\s]+)\))"), scheme("^[a-z]+:.*");
    std::vector<std::string> wrong;
    for (const SourceFile& page : pages) {
        const std::vector<std::string> prose = prose_of(page.lines);
        for (std::size_t i = 0; i < prose.size(); ++i)
            for (std::sregex_iterator l(prose[i].begin(), prose[i].end(), link), end; l != end; ++l) {
                const std::string target = (*l)[1];
                if (std::regex_match(target, scheme)) continue;
                const std::size_t hash = target.find('#');
                const std::string file = target.substr(0, hash);
                const auto path = (std::filesystem::path(page.path).parent_path() / file).lexically_normal();
                if (!file.empty() && !std::filesystem::exists(root / path)) {
                    wrong.push_back(page.path + ":" + std::to_string(i + 1) + ": there is no " +
                                    path.generic_string());
                } else if (hash != target.npos) {
                    const SourceFile other = file.empty() ? page : read_page(path.generic_string(), root);
                    if (!anchors_of(other.lines).contains(target.substr(hash + 1)))
                        wrong.push_back(page.path + ":" + std::to_string(i + 1) + ": there is no heading " +
                                        target);
                }
            }
    }
    return wrong;
}

} // namespace montelux::house
