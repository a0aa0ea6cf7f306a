// jackknife_error: the standard error of any estimate, from what it is without parts of the sample.
#pragma once

#include <cmath>
#include <span>

namespace montelux {

// `without`: the estimate without each of n independent parts of about the same size (Tukey 1958, "Bias and Confidence in
// Not Quite Large Samples"). Of a mean it is the standard error of the mean of the parts. 0 for fewer than two.
inline double jackknife_error(std::span<const double> without) {
    const auto n = static_cast<double>(without.size());
    if (without.size() < 2) return 0;
    double mean = 0, sum = 0;
    for (const double v : without) mean += v / n;
    for (const double v : without) sum += (v - mean) * (v - mean);
    return std::sqrt(sum * (n - 1) / n);
}

} // namespace montelux
