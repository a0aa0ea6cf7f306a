// Check of the parameters of every distribution.
#pragma once

#include <initializer_list>
#include <string_view>
#include <utility>

namespace montelux {

using NamedValue = std::pair<std::string_view, double>;

// Throws Error unless `holds`: "where: name = value, ...; expected ...".
void require_parameters(bool holds, std::string_view where, std::initializer_list<NamedValue> read,
                        std::string_view expected);

} // namespace montelux
