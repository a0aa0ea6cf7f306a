// The beta distribution on [0, 1].
#pragma once

#include <cmath>

#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/dist/parameters.h"
#include "montelux/mc/math/incomplete_functions.h"

namespace montelux {

// p = x^(a-1) (1-x)^(b-1) / B(a, b); P is the regularised incomplete beta function I_x(a, b), and X its
// inverse at xi.
class BetaDistribution : public SampledByInversion<BetaDistribution> {
  public:
    BetaDistribution(double a, double b) : a_(a), b_(b) {
        require_parameters(a > 0 && std::isfinite(a) && b > 0 && std::isfinite(b), "BetaDistribution",
                           {{"a", a}, {"b", b}}, "two finite parameters above zero");
    }
    double lower() const { return 0; }
    double upper() const { return 1; }
    // Infinite at 0 for a < 1, at 1 for b < 1.
    double pdf(double x) const { return incomplete::beta_pdf(a_, b_, x); }
    double cdf(double x) const { return incomplete::beta(a_, b_, x); }
    double cdf_complement(double x) const { return incomplete::beta_complement(a_, b_, x); }
    double quantile(double xi) const { return incomplete::beta_inverse(a_, b_, xi); }
    double quantile_complement(double q) const { return incomplete::beta_complement_inverse(a_, b_, q); }

  private:
    double a_, b_;
};

} // namespace montelux
