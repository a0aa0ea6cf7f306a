// Names as a sentence lists them.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace montelux::app {

// "a, b, c"
inline std::string joined(std::span<const std::string_view> names) {
    std::string text;
    for (std::string_view name : names) {
        if (!text.empty()) text += ", ";
        text += name;
    }
    return text;
}

} // namespace montelux::app
