// The Weibull distribution; Rayleigh's for shape 2.
#pragma once

#include <cmath>
#include <limits>

#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/dist/parameters.h"

namespace montelux {

// p = shape / scale z^(shape - 1) e^(-z^shape) on [0, infinity), z = x / scale:
// X = scale (-ln(1 - xi))^(1 / shape).
class WeibullDistribution : public SampledByInversion<WeibullDistribution> {
  public:
    explicit WeibullDistribution(double shape, double scale = 1) : shape_(shape), scale_(scale) {
        require_parameters(shape > 0 && std::isfinite(shape) && scale > 0 && std::isfinite(scale),
                           "WeibullDistribution", {{"shape", shape}, {"scale", scale}},
                           "a finite shape and a finite scale, both above zero");
    }
    double lower() const { return 0; }
    double upper() const { return std::numeric_limits<double>::infinity(); }
    // Infinite at 0 for a shape below 1.
    double pdf(double x) const {
        if (!(x >= 0) || std::isinf(x)) return 0;
        double z = x / scale_;
        return shape_ / scale_ * std::pow(z, shape_ - 1) * std::exp(-std::pow(z, shape_));
    }
    double cdf(double x) const { return x > 0 ? -std::expm1(-std::pow(x / scale_, shape_)) : 0; }
    double cdf_complement(double x) const { return x > 0 ? std::exp(-std::pow(x / scale_, shape_)) : 1; }
    double quantile(double xi) const { return scale_ * std::pow(-std::log1p(-xi), 1 / shape_); }
    double quantile_complement(double q) const { return scale_ * std::pow(-std::log(q), 1 / shape_); }

  private:
    double shape_, scale_;
};

} // namespace montelux
