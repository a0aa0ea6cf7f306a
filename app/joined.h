// Names as a sentence lists them.
#pragma once

#include <ranges>
#include <string>
#include <string_view>

namespace montelux::app {

// "a, b, c"
template <std::ranges::range Names>
std::string joined(const Names& names) {
    std::string text;
    for (const std::string_view name : names) {
        if (!text.empty()) text += ", ";
        text += name;
    }
    return text;
}

} // namespace montelux::app
