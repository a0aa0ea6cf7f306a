// Positive infinity: the error of what is not known yet.
#pragma once

#include <limits>

namespace montelux {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace montelux
