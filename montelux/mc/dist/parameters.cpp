#include "montelux/mc/dist/parameters.h"

#include <sstream>

#include "montelux/mc/math/error.h"

namespace montelux {

void require_parameters(bool holds, std::string_view where, std::initializer_list<NamedValue> read,
                        std::string_view expected) {
    if (holds) return;
    std::ostringstream what;
    const char* separator = "";
    for (const auto& [name, value] : read) {
        what << separator << name << " = " << value;
        separator = ", ";
    }
    what << "; expected " << expected;
    throw Error(where, what.str());
}

} // namespace montelux
