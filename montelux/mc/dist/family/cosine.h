// The cosine density on [0, pi/2).
#pragma once

#include <cmath>

#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/math/constants.h"

namespace montelux {

// p = cos x on [0, pi/2): X = asin xi.
class CosineDistribution : public SampledByInversion<CosineDistribution> {
  public:
    double lower() const { return 0; }
    double upper() const { return pi / 2; }
    double pdf(double x) const { return x >= 0 && x <= pi / 2 ? std::cos(x) : 0; }
    double cdf(double x) const { return x <= 0 ? 0 : (x >= pi / 2 ? 1 : std::sin(x)); }
    // 1 - sin x = 2 sin^2((pi/2 - x) / 2).
    double cdf_complement(double x) const {
        if (x <= 0) return 1;
        if (x >= pi / 2) return 0;
        double s = std::sin(0.5 * (pi / 2 - x));
        return 2 * s * s;
    }
    double quantile(double xi) const { return std::asin(xi); }
    double quantile_complement(double q) const {
        return q < 0.5 ? pi / 2 - 2 * std::asin(std::sqrt(0.5 * q)) : std::asin(1 - q);
    }
};

} // namespace montelux
