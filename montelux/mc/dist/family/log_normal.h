// The log-normal distribution: the exponential of a normal variable.
#pragma once

#include <cmath>
#include <limits>

#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/dist/parameters.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/incomplete_functions.h"

namespace montelux {

// p = e^(-z^2 / 2) / (x log_deviation sqrt(2 pi)) on (0, infinity), z = (ln x - log_mean) / log_deviation:
// X = exp(log_mean + log_deviation Phi^-1(xi)). The parameters are those of ln X.
class LogNormalDistribution : public SampledByInversion<LogNormalDistribution> {
  public:
    explicit LogNormalDistribution(double log_mean = 0, double log_deviation = 1)
        : log_mean_(log_mean), log_deviation_(log_deviation) {
        require_parameters(log_deviation > 0 && std::isfinite(log_deviation) && std::isfinite(log_mean),
                           "LogNormalDistribution",
                           {{"log_mean", log_mean}, {"log_deviation", log_deviation}},
                           "a finite log_mean and a finite log_deviation above zero");
    }
    double lower() const { return 0; }
    double upper() const { return std::numeric_limits<double>::infinity(); }
    double pdf(double x) const {
        if (!(x > 0) || std::isinf(x)) return 0;
        double z = standardised(x);
        return std::exp(-0.5 * z * z) / (x * log_deviation_ * std::sqrt(2 * pi));
    }
    double cdf(double x) const { return x > 0 ? incomplete::normal_cdf(standardised(x)) : 0; }
    double cdf_complement(double x) const {
        return x > 0 ? incomplete::normal_cdf_complement(standardised(x)) : 1;
    }
    double quantile(double xi) const {
        return std::exp(log_mean_ + log_deviation_ * incomplete::normal_quantile(xi));
    }
    double quantile_complement(double q) const {
        return std::exp(log_mean_ + log_deviation_ * incomplete::normal_quantile_complement(q));
    }

  private:
    double standardised(double x) const { return (std::log(x) - log_mean_) / log_deviation_; }

    double log_mean_, log_deviation_;
};

} // namespace montelux
