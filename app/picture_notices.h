// Notices about a picture besides its error: clamped light, and unreliable error bars.
#pragma once

#include "montelux/film/film_error.h"

namespace montelux::app {

// Mean luminances: what clamping took away, and what is left.
void print_clamped(double samples, double lost, double left);

// Says so where the error sits in few pixels, and where errors are rough or too young to tell.
void print_outliers(const OutlierReport& outliers);

} // namespace montelux::app
