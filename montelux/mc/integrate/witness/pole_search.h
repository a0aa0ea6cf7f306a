// Poles inside the domain: does the integral of |g| exist there, and can doubles resolve it?
#pragma once

#include <string>

#include "montelux/mc/integrate/witness/peak.h"
#include "montelux/mc/integrate/witness/slow_shells.h"

namespace montelux {

struct PoleReport {
    bool diverges = false;
    // Integral of |g| over the points that doubles do not tell from the pole, in one variable; 0 without a pole.
    double unresolved = 0;
    std::vector<double> u; // where
    // Around a pole of several variables, if masses fall slowly towards it; else without shells.
    SlowShells slow;
};

// Follows |g_component| from a witness to the greatest value along each variable, and compares dyadic shells around
// it: along the variable, where in several variables lines beside it must meet the same pole; and of balls. Some
// 150 evaluations in one variable, 400 in more.
PoleReport search_pole(RawValues& raw, const Witness& from, std::size_t component);

} // namespace montelux
