// Values of command line options.
#pragma once

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/mc/math/error.h"

namespace montelux::bench {

// "A,B" as A and B.
inline std::vector<std::string> comma_separated(std::string_view text) {
    std::vector<std::string> parts;
    while (!text.empty()) {
        const std::size_t comma = text.find(',');
        if (comma != 0) parts.emplace_back(text.substr(0, comma));
        text = comma == std::string_view::npos ? "" : text.substr(comma + 1);
    }
    return parts;
}

// Throws Error that names the option.
inline double number_in_range(std::string_view option, std::string_view text, double least, double most) {
    double value = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc() || end != text.data() + text.size() || !(value >= least && value <= most))
        throw Error(option, "'" + std::string(text) + "' is not a number in range");
    return value;
}

// The name begins with one of these.
inline bool begins_with_one_of(const std::vector<std::string>& beginnings, std::string_view name) {
    return std::any_of(beginnings.begin(), beginnings.end(),
                       [&](const std::string& beginning) { return name.starts_with(beginning); });
}

} // namespace montelux::bench
