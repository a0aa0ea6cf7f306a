// Numbers for JSON output, which knows neither NaN nor infinity.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

namespace montelux::app {

// null for NaN and infinities.
inline nlohmann::ordered_json json_number(double v) {
    if (!std::isfinite(v)) return nullptr;
    return v;
}

} // namespace montelux::app
