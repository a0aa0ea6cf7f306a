// The other integrators that Montelux is compared with; those that were not found at configure time are
// absent.
#pragma once

#include "bench/integrate/method.h"
#include <string>
#include <vector>

namespace montelux::bench {

// GNU Scientific Library: plain, MISER and VEGAS.
std::vector<Method> gsl_methods();
// The package cubature: adaptive by subdivision (h) and by order (p).
std::vector<Method> cubature_methods();
// The Python package vegas (VEGAS+), in a process of its own. `python` is the interpreter that can import it;
// where it cannot, the list is empty and `message` says why.
std::vector<Method> vegas_methods(const std::string& python, std::string& message);
// Replicates of scrambled Sobol' points.
std::vector<Method> sobol_methods();

} // namespace montelux::bench
