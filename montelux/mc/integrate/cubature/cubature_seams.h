// The parts of regions of one variable close to their faces, where no rule has points.
#pragma once

#include "montelux/mc/integrate/cubature/cubature_regions.h"

namespace montelux {

// The outermost points of a rule leave a part of its region unseen at either face. Where the values that two neighbours
// predict at their common face differ by more than their slopes explain, a jump may lie in those parts: raises the
// errors of both to what it may hide. True if any error has grown. One variable.
bool raise_seam_errors(CubatureRegions& regions);

// How much a component's value at x, in such a part of a region, differs from the face that the rule predicts, beyond what
// its slope explains; 0 elsewhere. One variable.
double surprise_near_face(const CubatureRegions& regions, std::size_t region, std::size_t component, double x,
                          double value);

} // namespace montelux
