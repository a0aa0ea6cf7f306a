// What a call throws, as text.
#pragma once

#include <functional>
#include <string>

#include "montelux/mc/math/error.h"

namespace montelux {

inline std::string message_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const Error& e) {
        return e.what();
    }
    return "no error";
}

} // namespace montelux
