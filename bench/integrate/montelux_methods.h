// The integrators of the library, as the comparison sees them.
#pragma once

#include "bench/integrate/method.h"
#include <cstdint>
#include <string>
#include <vector>

namespace montelux::bench {

// The default and every method that montelux::Method knows by name, as "montelux-<name>".
std::vector<Method> montelux_methods();

// Wall time of a method with an integrand of about 100 ns, on one thread and on two.
struct Scaling {
    std::string method;
    double nanoseconds_on_one; // an evaluation
    double speedup_on_two;
};
// Of those of our methods whose names are here, with this many evaluations: the best of three runs each.
std::vector<Scaling> measure_scaling(const std::vector<Method>& methods, std::uint64_t evaluations);

} // namespace montelux::bench
