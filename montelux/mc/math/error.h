// The one exception type of Montelux: where it happened, what went wrong, what to do.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace montelux {

// Thrown at the borders (files, arguments), never in the sampling loop. `where` is a file with line and
// column, a function, or an option; it may be empty.
class Error : public std::runtime_error {
  public:
    explicit Error(std::string_view what) : std::runtime_error(std::string(what)) {}
    Error(std::string_view where, std::string_view what)
        : std::runtime_error(where.empty() ? std::string(what)
                                           : std::string(where) + ": " + std::string(what)) {}
};

} // namespace montelux
