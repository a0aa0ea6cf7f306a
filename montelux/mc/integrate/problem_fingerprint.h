// problem_fingerprint: a number that identifies the problem to which the state of a run belongs.
#pragma once

#include <cstdint>
#include <string>

#include "montelux/mc/integrate/evaluator.h"
#include "montelux/mc/integrate/integrate.h"

namespace montelux {

// Of the integrand (by its values at four points, which are evaluated), the domain, the method and the
// options that change samples. `f` is on the evaluator's domain, in its own unit.
std::uint64_t problem_fingerprint(const Integrand& f, const Evaluator& evaluator, const std::string& method,
                                  const IntegrationOptions& options);

} // namespace montelux
