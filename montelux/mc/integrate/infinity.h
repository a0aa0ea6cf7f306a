// Positive infinity: the error of an unknown value.
#pragma once

#include <limits>

namespace montelux {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace montelux
