// The names of Mitsuba 0.x scenes (before version 2) as those of today.
#pragma once

#include <string>
#include <string_view>

#include "montelux/formats/mitsuba/object.h"
#include "montelux/formats/mitsuba/xml_values.h"

namespace montelux::mitsuba {

struct FormatVersion {
    int major = 3;

    bool is_old() const { return major < 2; }
};

// "3.0.0". An Error for versions after 3.
FormatVersion version_of(std::string_view text, const Place& place);

// "toWorld" as "to_world", "extIOR" as "ext_ior".
std::string to_snake_case(std::string_view name);

// Of an object of such a file, whose properties have names of today.
void upgrade(Object& object);

} // namespace montelux::mitsuba
