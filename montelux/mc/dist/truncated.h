// A distribution restricted to an interval.
#pragma once

#include <algorithm>
#include <utility>

#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/dist/parameters.h"

namespace montelux {

// D conditioned on lower <= X <= upper (either may be infinite): p / mass, with mass the probability of the
// interval under D, and X = P^-1(P(lower) + xi mass). Worked from whichever tail of D is nearer, so that an
// interval far out in a tail keeps the digits that the tail has: a normal law beyond 30 deviations is as
// exact as one beyond 0. Where an end cuts through the bulk of D, probabilities are differences, with an
// absolute error of about 1e-16 / mass.
template <Distribution1D D>
class Truncated : public SampledByInversion<Truncated<D>> {
  public:
    // Throws Error when the interval is empty or has no probability under D.
    Truncated(D distribution, double lower, double upper)
        : d_(std::move(distribution)), lower_(std::max(lower, d_.lower())),
          upper_(std::min(upper, d_.upper())) {
        require_parameters(lower < upper, "Truncated", {{"lower", lower}, {"upper", upper}},
                           "an interval that is not empty, lower < upper");
        below_ = d_.cdf(lower_);
        above_ = montelux::cdf_complement(d_, upper_);
        mass_ = mass_between(lower_, upper_);
        require_parameters(lower_ < upper_ && mass_ > 0, "Truncated",
                           {{"lower", lower}, {"upper", upper}, {"probability", mass_}},
                           "an interval that has a probability above zero");
    }
    double lower() const { return lower_; }
    double upper() const { return upper_; }
    // Of the interval under the distribution that was truncated.
    double mass() const { return mass_; }
    double pdf(double x) const { return x >= lower_ && x <= upper_ ? d_.pdf(x) / mass_ : 0; }
    double cdf(double x) const {
        return x <= lower_ ? 0 : (x >= upper_ ? 1 : std::min(1.0, mass_between(lower_, x) / mass_));
    }
    double cdf_complement(double x) const {
        return x <= lower_ ? 1 : (x >= upper_ ? 0 : std::min(1.0, mass_between(x, upper_) / mass_));
    }
    double quantile(double xi) const { return point(xi, 1 - xi); }
    double quantile_complement(double q) const { return point(1 - q, q); }

  private:
    double mass_between(double a, double b) const {
        double below = d_.cdf(a), above = montelux::cdf_complement(d_, b);
        if (below > 0.5) return montelux::cdf_complement(d_, a) - above;
        if (above > 0.5) return d_.cdf(b) - below;
        return 1 - below - above;
    }
    // p below and q = 1 - p above.
    double point(double p, double q) const {
        if (p <= 0) return lower_;
        if (q <= 0) return upper_;
        double from_below = below_ + p * mass_, from_above = above_ + q * mass_;
        double x =
            from_below < from_above ? d_.quantile(from_below) : montelux::quantile_complement(d_, from_above);
        return std::clamp(x, lower_, upper_);
    }

    D d_;
    double lower_, upper_;
    double below_ = 0, above_ = 0, mass_ = 0; // of d_
};

} // namespace montelux
