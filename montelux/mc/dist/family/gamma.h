// The gamma distribution; chi-squared and Erlang's are special cases.
#pragma once

#include <cmath>
#include <limits>

#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/dist/parameters.h"
#include "montelux/mc/math/incomplete_functions.h"

namespace montelux {

// p = z^(shape - 1) e^-z / (Gamma(shape) scale) on [0, infinity), z = x / scale; P is the regularised
// incomplete gamma function P(shape, z), and X = scale P^-1(shape, xi).
class GammaDistribution : public SampledByInversion<GammaDistribution> {
  public:
    explicit GammaDistribution(double shape, double scale = 1) : shape_(shape), scale_(scale) {
        require_parameters(shape > 0 && std::isfinite(shape) && scale > 0 && std::isfinite(scale),
                           "GammaDistribution", {{"shape", shape}, {"scale", scale}},
                           "a finite shape and a finite scale, both above zero");
    }
    double lower() const { return 0; }
    double upper() const { return std::numeric_limits<double>::infinity(); }
    // Infinite at 0 for a shape below 1.
    double pdf(double x) const { return incomplete::gamma_pdf(shape_, x / scale_) / scale_; }
    double cdf(double x) const { return incomplete::gamma_p(shape_, x / scale_); }
    double cdf_complement(double x) const { return incomplete::gamma_q(shape_, x / scale_); }
    double quantile(double xi) const { return scale_ * incomplete::gamma_p_inverse(shape_, xi); }
    double quantile_complement(double q) const { return scale_ * incomplete::gamma_q_inverse(shape_, q); }

  private:
    double shape_, scale_;
};

// Sum of the squares of `degrees_of_freedom` standard normal variables: gamma with shape
// degrees_of_freedom / 2 and scale 2. The number need not be whole.
class ChiSquaredDistribution : public GammaDistribution {
  public:
    explicit ChiSquaredDistribution(double degrees_of_freedom)
        : GammaDistribution(0.5 * checked(degrees_of_freedom), 2) {}

  private:
    static double checked(double degrees_of_freedom) {
        require_parameters(degrees_of_freedom > 0 && std::isfinite(degrees_of_freedom),
                           "ChiSquaredDistribution", {{"degrees_of_freedom", degrees_of_freedom}},
                           "a finite number above zero");
        return degrees_of_freedom;
    }
};

} // namespace montelux
