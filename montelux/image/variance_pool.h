// The variance of a pixel estimated from its neighbourhood, so that it hardly depends on the pixel's own
// value.
#pragma once

#include <span>
#include <vector>

namespace montelux {

// For each pixel, by rows, the mean of the variances in the 3 x 3 pixels around it, itself among them and
// cut off at the edges. Negative entries are variances that are not known: they stay as they are and are left
// out of their neighbours' means. Takes width * height entries.
//
// Why: a sample variance goes with the sample mean wherever samples are skewed (Cov = third moment / n), so
// a pixel that is too dark is also too sure of itself, and (value - truth) / error has a mean of minus half
// the mean's skewness though the value is unbiased. With n equal neighbours the pixel's own variance counts
// for one part in n, and so does that lean: a ninth of it is left here. The own part stays in because it
// bounds the score where one pixel is noisier than all around it (an edge, a highlight), which a mean of the
// neighbours alone cannot know.
std::vector<double> pool_variances(std::span<const double> variances, int width, int height);

} // namespace montelux
