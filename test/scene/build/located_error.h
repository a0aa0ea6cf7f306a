// located_error: the message with which building a scene fails; empty if it does not.
#pragma once

#include <string>

#include "montelux/scene/build/build_messages.h"

namespace montelux::testing {

template <typename Build>
std::string located_error(const Build& build) {
    try {
        build();
    } catch (const LocatedError& e) {
        return e.what();
    }
    return {};
}

} // namespace montelux::testing
