// Student's t distribution.
#pragma once

#include <cmath>
#include <limits>

#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/dist/parameters.h"
#include "montelux/mc/math/incomplete_functions.h"

namespace montelux {

// p proportional to (1 + z^2 / n)^(-(n+1)/2), z = (x - location) / scale, n degrees of freedom (any number
// above zero: 1 is Cauchy's law, large n tends to the normal one).
class StudentTDistribution : public SampledByInversion<StudentTDistribution> {
  public:
    explicit StudentTDistribution(double degrees_of_freedom, double location = 0, double scale = 1)
        : dof_(degrees_of_freedom), location_(location), scale_(scale) {
        require_parameters(
            dof_ > 0 && std::isfinite(dof_) && scale > 0 && std::isfinite(scale) && std::isfinite(location),
            "StudentTDistribution",
            {{"degrees_of_freedom", degrees_of_freedom}, {"location", location}, {"scale", scale}},
            "a finite location, and finite degrees_of_freedom and scale above zero");
    }
    double lower() const { return -std::numeric_limits<double>::infinity(); }
    double upper() const { return std::numeric_limits<double>::infinity(); }
    double pdf(double x) const { return incomplete::student_t_pdf(dof_, (x - location_) / scale_) / scale_; }
    double cdf(double x) const { return incomplete::student_t_cdf(dof_, (x - location_) / scale_); }
    double cdf_complement(double x) const {
        return incomplete::student_t_cdf(dof_, (location_ - x) / scale_);
    }
    double quantile(double xi) const { return location_ + scale_ * incomplete::student_t_quantile(dof_, xi); }
    double quantile_complement(double q) const {
        return location_ - scale_ * incomplete::student_t_quantile(dof_, q);
    }

  private:
    double dof_, location_, scale_;
};

} // namespace montelux
