#include "montelux/formats/mitsuba/parameters.h"

#include <algorithm>
#include <cctype>

#include "montelux/mc/math/nearest_name.h"
#include "montelux/scene/build/quoted.h"

namespace montelux::mitsuba {
namespace {

constexpr std::size_t max_length = std::size_t{1} << 20;

bool is_name_character(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

} // namespace

std::string Parameters::substituted(std::string_view text, const Place& place) {
    std::string result;
    while (!text.empty()) {
        const std::size_t dollar = text.find('$');
        if (dollar > 0 && dollar != std::string_view::npos && text[dollar - 1] == '\\') {
            result.append(text.substr(0, dollar - 1)).push_back('$');
            text.remove_prefix(dollar + 1);
            continue;
        }
        result.append(text.substr(0, dollar));
        if (dollar == std::string_view::npos) break;
        text.remove_prefix(dollar + 1);
        std::size_t length = static_cast<std::size_t>(
            std::find_if_not(text.begin(), text.end(), is_name_character) - text.begin());
        const std::string_view whole = text.substr(0, length);
        auto found = values_.end();
        for (; length > 0 && found == values_.end(); --length)
            found = values_.find(std::string(text.substr(0, length)));
        if (found == values_.end())
            place.error("the parameter " + in_quotes("$" + std::string(whole)) + " has no value" +
                        did_you_mean(whole, names()) + "; give one with -D " + shown(whole) + "=VALUE");
        used_.insert(found->first);
        result += found->second;
        text.remove_prefix(found->first.size());
        if (result.size() > max_length) place.error("parameters make this text longer than a mebibyte");
    }
    return result;
}

std::vector<std::string> Parameters::unused() const {
    std::vector<std::string> all;
    for (const std::string& name : given_)
        if (!used_.contains(name)) all.push_back(in_quotes(name));
    return all;
}

std::vector<std::string_view> Parameters::names() const {
    std::vector<std::string_view> all;
    for (const auto& [name, value] : values_) all.emplace_back(name);
    return all;
}

} // namespace montelux::mitsuba
