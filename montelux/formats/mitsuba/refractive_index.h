// Indices of refraction of a Mitsuba scene: numbers, or names of substances.
#pragma once

#include <string_view>

#include "montelux/formats/mitsuba/plugin.h"

namespace montelux::mitsuba {

// `int_ior` over `ext_ior`, which is that of air by default; `inside` names the default of the first.
double relative_index(Plugin& bsdf, std::string_view inside);
// The same of an interface that must bend light: not 1.
double index_of_interface(Plugin& bsdf, std::string_view inside);

} // namespace montelux::mitsuba
