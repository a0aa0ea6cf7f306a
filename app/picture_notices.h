// What is told of a picture beside its error: light that was taken away, and errors that are rough.
#pragma once

#include "montelux/film/film_error.h"

namespace montelux::app {

// Mean luminances: what clamping took away, and what is left.
void print_clamped(double samples, double lost, double left);

// Says so where the error sits in few pixels, and where errors are rough or too young to tell.
void print_outliers(const OutlierReport& outliers);

} // namespace montelux::app
