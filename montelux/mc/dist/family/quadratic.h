// The quadratic density on [-1, 1].
#pragma once

#include <cmath>

#include "montelux/mc/dist/distribution_1d.h"

namespace montelux {

// p = 3 x^2 / 2 on [-1, 1]: X = cbrt(2 xi - 1).
class QuadraticDistribution : public SampledByInversion<QuadraticDistribution> {
  public:
    double lower() const { return -1; }
    double upper() const { return 1; }
    double pdf(double x) const { return x >= -1 && x <= 1 ? 1.5 * x * x : 0; }
    // (1 + x^3) / 2 without cancellation at -1.
    double cdf(double x) const { return x <= -1 ? 0 : (x >= 1 ? 1 : 0.5 * (1 + x) * (1 - x + x * x)); }
    double cdf_complement(double x) const { return cdf(-x); }
    double quantile(double xi) const { return std::cbrt(2 * xi - 1); }
    double quantile_complement(double q) const { return std::cbrt(1 - 2 * q); }
};

} // namespace montelux
