// An integrand that is zero outside of a domain, for points drawn without regard to its borders.
#pragma once

#include "montelux/mc/integrate/domain.h"
#include "montelux/mc/integrate/integrand.h"

namespace montelux {

// f where the coordinates lie in the ranges of the domain, else zero without a call of f. For domains other
// than boxes it is f itself.
Integrand restricted(const Integrand& f, const Domain& domain);

} // namespace montelux
