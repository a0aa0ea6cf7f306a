// Formulas, as the program takes them, translated to a function in C for devices.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "montelux/mc/device/kernel_text.h"

namespace montelux {

// Numbers, names, brackets, + - * / ^ (which binds more than a minus sign before it, and to the right), comparisons,
// && || (1 or 0), c ? a : b, the constants pi, e, inf and nan unless a variable or given constant has that name, and
// functions: those of muParser, and erf, erfc, gamma, lgamma, expm1, log1p, cbrt, floor, ceil, pow, hypot, mod. Each
// formula is a component; a single one is a function that returns its value. Throws Error with the place of what cannot
// be read.
FunctionSource formula_source(std::span<const std::string> formulas, std::span<const std::string> variables,
                              std::span<const std::pair<std::string, double>> constants = {});

} // namespace montelux
