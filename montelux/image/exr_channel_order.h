// The order of an image's channels: colour first, then layers by name.
#pragma once

#include <string>
#include <string_view>
#include <tuple>

namespace montelux {

// EXR files list channels alphabetically (A, B, G, R). Here: R, G, B, A (or Y, A; X, Y, Z), then each layer
// by name with the same order inside.
inline bool channel_before(const std::string& a, const std::string& b) {
    auto key = [](std::string_view name) {
        auto dot = name.rfind('.');
        std::string_view layer = dot == std::string_view::npos ? std::string_view() : name.substr(0, dot);
        std::string_view last = dot == std::string_view::npos ? name : name.substr(dot + 1);
        static constexpr std::string_view order = "RGBXYZA";
        std::size_t rank = last.size() == 1 ? order.find(last) : std::string_view::npos;
        return std::tuple(layer, rank, last);
    };
    return key(a) < key(b);
}

} // namespace montelux
