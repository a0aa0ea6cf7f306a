// Text of a scene file, quoted for messages.
#pragma once

#include <string>
#include <string_view>

namespace montelux {

// At most 40 bytes of UTF-8; unprintable characters become '?'.
std::string shown(std::string_view text);

// "'text'"
inline std::string quoted(std::string_view text) { return "'" + shown(text) + "'"; }
// The same: for a std::string, `quoted` would find the one of the standard library.
inline std::string in_quotes(std::string_view text) { return quoted(text); }

} // namespace montelux
