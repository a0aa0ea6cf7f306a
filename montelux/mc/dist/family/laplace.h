// The Laplace (two-sided exponential) distribution.
#pragma once

#include <cmath>
#include <limits>

#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/dist/parameters.h"

namespace montelux {

// p = e^-|z| / (2 scale), z = (x - location) / scale: X = location + scale ln(2 xi) below the middle, and its
// mirror image above.
class LaplaceDistribution : public SampledByInversion<LaplaceDistribution> {
  public:
    explicit LaplaceDistribution(double location = 0, double scale = 1) : location_(location), scale_(scale) {
        require_parameters(scale > 0 && std::isfinite(scale) && std::isfinite(location),
                           "LaplaceDistribution", {{"location", location}, {"scale", scale}},
                           "a finite location and a finite scale above zero");
    }
    double lower() const { return -std::numeric_limits<double>::infinity(); }
    double upper() const { return std::numeric_limits<double>::infinity(); }
    double pdf(double x) const { return std::exp(-std::abs((x - location_) / scale_)) / (2 * scale_); }
    double cdf(double x) const { return below((x - location_) / scale_); }
    double cdf_complement(double x) const { return below((location_ - x) / scale_); }
    double quantile(double xi) const { return location_ + scale_ * point(xi); }
    double quantile_complement(double q) const { return location_ - scale_ * point(q); }

  private:
    static double below(double z) { return z < 0 ? 0.5 * std::exp(z) : 1 - 0.5 * std::exp(-z); }
    static double point(double p) { return p < 0.5 ? std::log(2 * p) : -std::log(2 * (1 - p)); }

    double location_, scale_;
};

} // namespace montelux
