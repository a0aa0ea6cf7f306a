// The normal distribution.
#pragma once

#include <cmath>
#include <limits>

#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/dist/parameters.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/incomplete_functions.h"

namespace montelux {

// p = e^(-z^2 / 2) / (deviation sqrt(2 pi)), z = (x - mean) / deviation: X = mean + deviation Phi^-1(xi).
class NormalDistribution : public SampledByInversion<NormalDistribution> {
  public:
    explicit NormalDistribution(double mean = 0, double deviation = 1) : mean_(mean), deviation_(deviation) {
        require_parameters(deviation > 0 && std::isfinite(deviation) && std::isfinite(mean),
                           "NormalDistribution", {{"mean", mean}, {"deviation", deviation}},
                           "a finite mean and a finite deviation above zero");
    }
    double lower() const { return -std::numeric_limits<double>::infinity(); }
    double upper() const { return std::numeric_limits<double>::infinity(); }
    double pdf(double x) const {
        double z = (x - mean_) / deviation_;
        return std::exp(-0.5 * z * z) / (deviation_ * std::sqrt(2 * pi));
    }
    double cdf(double x) const { return incomplete::normal_cdf((x - mean_) / deviation_); }
    double cdf_complement(double x) const {
        return incomplete::normal_cdf_complement((x - mean_) / deviation_);
    }
    // Minus infinity for xi = 0.
    double quantile(double xi) const { return mean_ + deviation_ * incomplete::normal_quantile(xi); }
    double quantile_complement(double q) const {
        return mean_ + deviation_ * incomplete::normal_quantile_complement(q);
    }

  private:
    double mean_, deviation_;
};

} // namespace montelux
