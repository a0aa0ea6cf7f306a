// Checks what an integration is asked for, before any work.
#pragma once

#include "montelux/mc/integrate/integrate.h"

namespace montelux {

// Throws Error if a limit is negative or not a number, or if options contradict each other.
void check_request(const Budget& budget, const IntegrationOptions& options);

} // namespace montelux
