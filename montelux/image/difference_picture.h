// A picture of the signed difference of two pictures: blue where the first is darker, red where it is
// brighter.
#pragma once

#include "montelux/image/metrics.h"

namespace montelux {

enum class DifferenceMeasure {
    relative, // sum over channels of (a - b), over the sum of |b| + 1/1000 of the picture's mean sum
    z_score   // sum over channels of (a - b), over the root of the summed squared standard errors
};

struct DifferencePicture {
    Image picture;     // 8-bit sRGB
    double full_scale; // the difference at which the colours are fullest
};

// White is no difference; magenta marks pixels without a finite one. With `full_scale` 0 it becomes the
// 99th percentile of the absolute differences (1 when all are 0).
// Throws Error when sizes or channels differ, or for z_score without any standard error.
DifferencePicture difference_picture(const MeasuredPicture& a, const MeasuredPicture& b,
                                     DifferenceMeasure measure = DifferenceMeasure::relative,
                                     double full_scale = 0);

} // namespace montelux
