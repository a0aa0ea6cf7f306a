// Notices about a picture besides its error: clamped light, and unreliable error bars.
#pragma once

#include <optional>
#include <string>

#include "montelux/film/film_error.h"

namespace montelux::app {

// ", visible in 61 % of the pixels": behind a relative error, from visible_error_share.
std::string visible_text(const std::optional<double>& share);

// Mean luminances: removed by clamping, and remaining.
void print_clamped(double samples, double lost, double left);

// Prints if few pixels carry most of the error, and if error bars are unreliable.
void print_outliers(const OutlierReport& outliers);

} // namespace montelux::app
