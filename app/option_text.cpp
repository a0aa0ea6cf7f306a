#include "app/option_text.h"

#include <CLI/CLI.hpp>
#include <cctype>
#include <string_view>

namespace montelux::app {

namespace {

bool is_name(std::string_view word) {
    if (word.empty()) return false;
    for (const char c : word)
        if (!std::islower(static_cast<unsigned char>(c)) && !std::isdigit(static_cast<unsigned char>(c)) &&
            c != '-' && c != '_')
            return false;
    return true;
}

// The pieces of a list, or nothing unless all are names and there are two or more.
std::vector<std::string> names(std::string_view list, std::string_view separator) {
    std::vector<std::string> found;
    for (;;) {
        const std::size_t end = list.find(separator);
        const std::string_view word = list.substr(0, end);
        if (!is_name(word)) return {};
        found.emplace_back(word);
        if (end == std::string_view::npos) break;
        list.remove_prefix(end + separator.size());
    }
    if (found.size() < 2) found.clear();
    return found;
}

} // namespace

bool is_flag(const CLI::Option& option) { return option.get_items_expected_max() == 0; }

std::string option_type(const CLI::Option& option) {
    const std::string type = is_flag(option) ? "" : option.get_type_name();
    return type.substr(0, type.find(':')); // descriptions of validators follow the colon
}

std::vector<std::string> option_choices(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    const std::string& help = option.get_description();
    if (const std::size_t brace = type.find(":{"); brace != std::string::npos)
        return names(std::string_view(type).substr(brace + 2, type.find('}') - brace - 2), ",");
    if (type.find('|') != std::string::npos) return names(type, "|");
    for (std::size_t colon = help.find(": "); colon != std::string::npos;
         colon = help.find(": ", colon + 1)) {
        const std::string_view rest = std::string_view(help).substr(colon + 2);
        std::vector<std::string> list = names(rest.substr(0, rest.find_first_of(".;")), ", ");
        if (!list.empty()) return list;
    }
    return {};
}

} // namespace montelux::app
