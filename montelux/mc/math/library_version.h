// A library that this build uses, for instance {"OpenEXR", "3.1.5"}.
#pragma once

#include <string>

namespace montelux {

struct LibraryVersion {
    std::string name;
    std::string version; // empty: the build was made without this optional library
};

} // namespace montelux
