// The Pareto distribution.
#pragma once

#include <cmath>
#include <limits>

#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/dist/parameters.h"

namespace montelux {

// p = index / minimum (minimum / x)^(index + 1) on [minimum, infinity): X = minimum (1 - xi)^(-1 / index).
class ParetoDistribution : public SampledByInversion<ParetoDistribution> {
  public:
    explicit ParetoDistribution(double index, double minimum = 1) : index_(index), minimum_(minimum) {
        require_parameters(index > 0 && std::isfinite(index) && minimum > 0 && std::isfinite(minimum),
                           "ParetoDistribution", {{"index", index}, {"minimum", minimum}},
                           "a finite index and a finite minimum, both above zero");
    }
    double lower() const { return minimum_; }
    double upper() const { return std::numeric_limits<double>::infinity(); }
    double pdf(double x) const { return x >= minimum_ ? index_ / x * std::pow(minimum_ / x, index_) : 0; }
    // log1p keeps the digits next to the minimum.
    double cdf(double x) const {
        return x > minimum_ ? -std::expm1(-index_ * std::log1p((x - minimum_) / minimum_)) : 0;
    }
    double cdf_complement(double x) const { return x > minimum_ ? std::pow(minimum_ / x, index_) : 1; }
    double quantile(double xi) const { return minimum_ * std::exp(-std::log1p(-xi) / index_); }
    double quantile_complement(double q) const { return minimum_ * std::pow(q, -1 / index_); }

  private:
    double index_, minimum_;
};

} // namespace montelux
