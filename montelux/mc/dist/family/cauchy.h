// The Cauchy (Lorentz, Breit-Wigner) distribution.
#pragma once

#include <cmath>
#include <limits>

#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/dist/parameters.h"
#include "montelux/mc/math/constants.h"

namespace montelux {

// p = 1 / (pi scale (1 + z^2)), z = (x - location) / scale: X = location + scale tan(pi (xi - 1/2)). `scale`
// is the half width at half maximum.
class CauchyDistribution : public SampledByInversion<CauchyDistribution> {
  public:
    explicit CauchyDistribution(double location = 0, double scale = 1) : location_(location), scale_(scale) {
        require_parameters(scale > 0 && std::isfinite(scale) && std::isfinite(location), "CauchyDistribution",
                           {{"location", location}, {"scale", scale}},
                           "a finite location and a finite scale above zero");
    }
    double lower() const { return -std::numeric_limits<double>::infinity(); }
    double upper() const { return std::numeric_limits<double>::infinity(); }
    double pdf(double x) const {
        double z = (x - location_) / scale_;
        return 1 / (pi * scale_ * (1 + z * z));
    }
    double cdf(double x) const { return std::atan2(1.0, (location_ - x) / scale_) / pi; }
    double cdf_complement(double x) const { return std::atan2(1.0, (x - location_) / scale_) / pi; }
    double quantile(double xi) const { return location_ - scale_ * upper_point(xi); }
    double quantile_complement(double q) const { return location_ + scale_ * upper_point(q); }

  private:
    // The z with probability q above it; 1 - q is exact where it is used.
    static double upper_point(double q) {
        if (q < 0.25) return 1 / std::tan(pi * q);
        if (q > 0.75) return -1 / std::tan(pi * (1 - q));
        return std::tan(pi * (0.5 - q));
    }

    double location_, scale_;
};

} // namespace montelux
