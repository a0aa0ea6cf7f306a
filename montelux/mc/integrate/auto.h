// Auto: the method that picks the method, and says which and why.
#pragma once

#include <memory>
#include <string_view>

#include "montelux/mc/integrate/estimator.h"

namespace montelux {

// Up to eight variables begin with deterministic cubature, whose first regions cost less than any sampling
// method needs to say anything. As long as its error falls so fast that it should reach the target (or,
// without a target, the smaller error) before sampling would, it goes on; else, or when it warns,
// Adaptive takes over from the start. One variable more often stays with cubature, more than eight begin with
// Adaptive, more than 1024 take BasicMonteCarlo. The result's `method` and `reason` say what was picked;
// naming a method overrules it.
struct Auto {
    static constexpr std::string_view name = "auto";

    std::unique_ptr<Estimator> estimator(const Problem& problem) const;
};

} // namespace montelux
