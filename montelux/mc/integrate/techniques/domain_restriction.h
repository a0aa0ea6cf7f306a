// An integrand that is zero outside a domain, for points that are drawn without regard to its borders.
#pragma once

#include "montelux/mc/integrate/domain.h"
#include "montelux/mc/integrate/integrand.h"

namespace montelux {

// f where the coordinates lie in the ranges of the domain, else zero without a call of f. Domains other than
// boxes have no such test; f stands for itself there.
Integrand restricted(const Integrand& f, const Domain& domain);

} // namespace montelux
