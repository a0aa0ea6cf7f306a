// The uplift tables of the embedded file, in order.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace montelux {

struct RgbUpliftLayout {
    std::string_view space;
    int resolution;

    constexpr std::size_t node_count() const {
        auto n = static_cast<std::size_t>(resolution);
        return 3 * n * n * n;
    }
};

inline constexpr std::array<RgbUpliftLayout, 4> rgb_uplift_layouts{
    {{"srgb", 56}, {"dci-p3", 32}, {"rec2020", 32}, {"aces2065-1", 24}}};

} // namespace montelux
