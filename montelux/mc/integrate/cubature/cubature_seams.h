// Jumps between neighbouring regions of one variable, where no rule has points.
#pragma once

#include "montelux/mc/integrate/cubature/cubature_regions.h"

namespace montelux {

// The outermost points of a rule leave a part of its region unseen at either face. Where the values that two neighbours
// predict at their common face differ by more than their slopes explain, a jump may lie in those parts: raises the
// errors of both to what it may hide. True if any error has grown. One variable.
bool raise_seam_errors(CubatureRegions& regions);

} // namespace montelux
