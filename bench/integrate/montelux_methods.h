// The integrators of the library, as the comparison sees them.
#pragma once

#include "bench/integrate/method.h"
#include <vector>

namespace montelux::bench {

// Every method that montelux::Method knows by name, as "montelux-<name>".
std::vector<Method> montelux_methods();

} // namespace montelux::bench
