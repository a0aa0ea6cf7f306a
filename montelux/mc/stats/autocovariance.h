// Autocovariances of a series at all lags, by fast Fourier transforms.
#pragma once

#include <span>
#include <vector>

namespace montelux {

// Entry k: sum over i of (x_i - mean)(x_(i+k) - mean), over the number of values; for k below that number. Time
// n log n. The series is padded by zeros, so that its ends do not meet (Geyer 1992, "Practical Markov Chain Monte
// Carlo", section 3.1, on dividing by n at every lag).
std::vector<double> autocovariance(std::span<const double> x);

} // namespace montelux
