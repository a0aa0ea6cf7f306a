// The variance of a pixel pooled over its neighbourhood, so that it hardly depends on the pixel's own value.
#pragma once

#include <span>
#include <vector>

namespace montelux {

// For each pixel, by rows, the mean of the variances in the 3 x 3 pixels around it, including its own, cut
// off at the edges. Negative entries are unknown variances: they stay negative and are left out of their
// neighbours' means. Takes width * height entries.
//
// Why: a sample variance is correlated with the sample mean if samples are skewed (Cov = third moment / n),
// so a pixel that is too dark also has too small an error, and (value - truth) / error has a mean of minus
// half the mean's skewness though the value is unbiased. Averaging over n pixels leaves 1/n of that mean,
// here a ninth. The pixel's own variance is included because it bounds the score of a pixel noisier than its
// neighbours (an edge, a highlight).
std::vector<double> pool_variances(std::span<const double> variances, int width, int height);

} // namespace montelux
