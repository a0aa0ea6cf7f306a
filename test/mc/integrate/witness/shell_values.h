// Values in shells by a formula.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "montelux/mc/integrate/witness/shells.h"

namespace montelux {

// |g| at distance r = 2^-k from a formula in r.
template <typename F>
ShellValues of(F f) {
    return [f](std::span<const double> exponents) {
        std::vector<double> g;
        for (double k : exponents) g.push_back(f(std::exp2(-k)));
        return g;
    };
}

} // namespace montelux
