// The exponential distribution: waiting times, free paths.
#pragma once

#include <cmath>
#include <limits>

#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/dist/parameters.h"

namespace montelux {

// p = rate e^(-rate x) on [0, infinity): X = -ln(1 - xi) / rate.
class ExponentialDistribution : public SampledByInversion<ExponentialDistribution> {
  public:
    explicit ExponentialDistribution(double rate) : rate_(rate) {
        require_parameters(rate > 0 && std::isfinite(rate), "ExponentialDistribution", {{"rate", rate}},
                           "a finite rate above zero");
    }
    double lower() const { return 0; }
    double upper() const { return std::numeric_limits<double>::infinity(); }
    double pdf(double x) const { return x >= 0 ? rate_ * std::exp(-rate_ * x) : 0; }
    double cdf(double x) const { return x > 0 ? -std::expm1(-rate_ * x) : 0; }
    double cdf_complement(double x) const { return x > 0 ? std::exp(-rate_ * x) : 1; }
    // log1p keeps the digits of small xi.
    double quantile(double xi) const { return -std::log1p(-xi) / rate_; }
    double quantile_complement(double q) const { return -std::log(q) / rate_; }

  private:
    double rate_;
};

} // namespace montelux
