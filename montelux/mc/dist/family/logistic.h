// The logistic distribution.
#pragma once

#include <cmath>
#include <limits>

#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/dist/parameters.h"

namespace montelux {

// p = e^-z / (scale (1 + e^-z)^2), z = (x - location) / scale: X = location + scale ln(xi / (1 - xi)).
class LogisticDistribution : public SampledByInversion<LogisticDistribution> {
  public:
    explicit LogisticDistribution(double location = 0, double scale = 1)
        : location_(location), scale_(scale) {
        require_parameters(scale > 0 && std::isfinite(scale) && std::isfinite(location),
                           "LogisticDistribution", {{"location", location}, {"scale", scale}},
                           "a finite location and a finite scale above zero");
    }
    double lower() const { return -std::numeric_limits<double>::infinity(); }
    double upper() const { return std::numeric_limits<double>::infinity(); }
    double pdf(double x) const {
        double e = std::exp(-std::abs((x - location_) / scale_));
        return e / (scale_ * (1 + e) * (1 + e));
    }
    double cdf(double x) const { return 1 / (1 + std::exp((location_ - x) / scale_)); }
    double cdf_complement(double x) const { return 1 / (1 + std::exp((x - location_) / scale_)); }
    double quantile(double xi) const { return location_ + scale_ * (std::log(xi) - std::log1p(-xi)); }
    double quantile_complement(double q) const { return location_ + scale_ * (std::log1p(-q) - std::log(q)); }

  private:
    double location_, scale_;
};

} // namespace montelux
