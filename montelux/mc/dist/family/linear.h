// The linear density p = 2x on [0, 1), and its restriction to any interval right of zero.
#pragma once

#include <algorithm>
#include <cmath>

#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/dist/parameters.h"

namespace montelux {

// p proportional to x on [lower, upper), lower >= 0. On [0, 1): p = 2x, X = sqrt(xi); on [2, 4):
// P = (x^2 - 4) / 12, X = 2 sqrt(3 xi + 1).
class LinearDistribution : public SampledByInversion<LinearDistribution> {
  public:
    explicit LinearDistribution(double lower = 0, double upper = 1)
        : lower_(lower), upper_(upper), span_((upper - lower) * (upper + lower)) {
        require_parameters(lower >= 0 && lower < upper && std::isfinite(span_), "LinearDistribution",
                           {{"lower", lower}, {"upper", upper}}, "0 <= lower < upper, both finite");
    }
    double lower() const { return lower_; }
    double upper() const { return upper_; }
    double pdf(double x) const { return x >= lower_ && x <= upper_ ? 2 * x / span_ : 0; }
    double cdf(double x) const {
        return x <= lower_ ? 0 : (x >= upper_ ? 1 : (x - lower_) * (x + lower_) / span_);
    }
    double cdf_complement(double x) const {
        return x <= lower_ ? 1 : (x >= upper_ ? 0 : (upper_ - x) * (upper_ + x) / span_);
    }
    double quantile(double xi) const { return std::min(upper_, std::sqrt(lower_ * lower_ + xi * span_)); }
    double quantile_complement(double q) const {
        return std::max(lower_, std::sqrt(std::max(0.0, upper_ * upper_ - q * span_)));
    }

  private:
    double lower_, upper_, span_;
};

} // namespace montelux
