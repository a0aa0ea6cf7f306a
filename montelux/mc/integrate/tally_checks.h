// What a tally says about the end of a run: an error reached, nothing found, nothing left but rounding.
#pragma once

#include "montelux/mc/integrate/estimator.h"

namespace montelux {

// The error of each component is at most `absolute`, or at most `relative` times its value; 0 of both is met
// by an error of zero alone. `absolute` is in the unit of the tally.
bool meets(const Tally& tally, double relative, double absolute);
// A value and its error are zero: either the function is zero, or no point has hit its peaks.
bool nothing_found(const Tally& tally);
// All errors are below the resolution of doubles.
bool is_rounding(const Tally& tally);

} // namespace montelux
