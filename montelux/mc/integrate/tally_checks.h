// What a tally says about the end of a run (an error reached, nothing found, nothing left but rounding), and points in messages.
#pragma once

#include <string>
#include <vector>

#include "montelux/mc/integrate/estimator.h"

namespace montelux {

// The error of each component is within the tolerance of the request; without a target an error of zero alone is.
bool meets(const Tally& tally, const StepRequest& request);
// A value and its error are zero: either the function is zero, or no point has hit its peaks.
bool nothing_found(const Tally& tally);
// "(1, 2)": at most eight coordinates, with all of their digits.
std::string point_text(const std::vector<double>& point);
// All errors are below the resolution of doubles.
bool is_rounding(const Tally& tally);

} // namespace montelux
