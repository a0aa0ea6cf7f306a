// Numbers for JSON output, which knows neither NaN nor infinity.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

namespace montelux::app {

// null for NaN, the strings "inf" and "-inf" for infinities.
inline nlohmann::ordered_json json_number(double v) {
    if (std::isnan(v)) return nullptr;
    if (std::isinf(v)) return v > 0 ? "inf" : "-inf";
    return v;
}

} // namespace montelux::app
