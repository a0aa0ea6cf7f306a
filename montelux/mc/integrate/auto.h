// Auto: chooses the method, and says which and why.
#pragma once

#include <memory>
#include <string_view>

#include "montelux/mc/integrate/estimator.h"

namespace montelux {

// Up to eight variables begin with deterministic cubature, whose first regions are cheaper than any useful
// number of samples. Cubature continues as long as its error falls fast enough to reach the target (or,
// without a target, a smaller error) before sampling would; otherwise, or after a warning, Adaptive starts
// afresh. One variable stays with cubature more often, more than eight begin with Adaptive, more than 1024
// take BasicMonteCarlo. The result's `method` and `reason` contain the choice; naming a method overrules it.
struct Auto {
    static constexpr std::string_view name = "auto";
    static constexpr FirstLookUse first_look = FirstLookUse::always;

    std::unique_ptr<Estimator> estimator(const Problem& problem) const;
};

} // namespace montelux
