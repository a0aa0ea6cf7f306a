// Text of a scene file as it may stand in a message.
#pragma once

#include <string>
#include <string_view>

namespace montelux {

// At most 40 bytes of UTF-8, with what cannot be printed as '?'.
std::string shown(std::string_view text);

// "'text'"
inline std::string quoted(std::string_view text) { return "'" + shown(text) + "'"; }

} // namespace montelux
