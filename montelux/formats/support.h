// Support: how much of a feature of a scene format is read.
#pragma once

#include <cstdint>
#include <string_view>

namespace montelux {

enum class Support : std::uint8_t {
    full,
    in_part,   // the rest is refused, or ignored with a warning where it is a loss
    otherwise, // read without effect, or as something else, with a warning
    none,      // an error; what is optional is ignored, with a warning
};

constexpr std::string_view name_of(Support s) {
    switch (s) {
    case Support::full:
        return "yes";
    case Support::in_part:
        return "in part";
    case Support::otherwise:
        return "otherwise";
    case Support::none:
        return "no";
    }
    return {};
}

} // namespace montelux
