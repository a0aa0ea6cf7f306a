// The uniform distribution on an interval.
#pragma once

#include <algorithm>
#include <cmath>

#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/dist/parameters.h"

namespace montelux {

// p = 1 / (upper - lower): X = lower + xi (upper - lower).
class UniformDistribution : public SampledByInversion<UniformDistribution> {
  public:
    explicit UniformDistribution(double lower = 0, double upper = 1) : lower_(lower), upper_(upper) {
        require_parameters(lower < upper && std::isfinite(upper - lower), "UniformDistribution",
                           {{"lower", lower}, {"upper", upper}},
                           "a finite interval that is not empty, lower < upper");
    }
    double lower() const { return lower_; }
    double upper() const { return upper_; }
    double pdf(double x) const { return x >= lower_ && x <= upper_ ? 1 / (upper_ - lower_) : 0; }
    double cdf(double x) const { return std::clamp((x - lower_) / (upper_ - lower_), 0.0, 1.0); }
    double cdf_complement(double x) const { return std::clamp((upper_ - x) / (upper_ - lower_), 0.0, 1.0); }
    double quantile(double xi) const { return lower_ + xi * (upper_ - lower_); }
    double quantile_complement(double q) const { return upper_ - q * (upper_ - lower_); }

  private:
    double lower_, upper_;
};

} // namespace montelux
