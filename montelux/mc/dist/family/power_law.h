// A power of x on an interval of the positive numbers.
#pragma once

#include <cmath>
#include <limits>

#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/dist/parameters.h"

namespace montelux {

// p proportional to x^exponent on [lower, upper], 0 <= lower < upper. With m = exponent + 1:
// P = (x^m - lower^m) / (upper^m - lower^m), X = (lower^m + xi (upper^m - lower^m))^(1/m); for exponent -1,
// P = ln(x / lower) / ln(upper / lower). lower = 0 needs an exponent above -1, upper = infinity one below
// -1. Evaluated in logarithms, so that no power overflows and none cancels.
class PowerLawDistribution : public SampledByInversion<PowerLawDistribution> {
  public:
    explicit PowerLawDistribution(double exponent, double lower = 0, double upper = 1)
        : m_(exponent + 1), lower_(lower), upper_(upper),
          span_(lower > 0 ? std::log(upper) - std::log(lower) : std::numeric_limits<double>::infinity()) {
        bool interval = lower >= 0 && lower < upper && std::isfinite(lower) && std::isfinite(exponent);
        require_parameters(interval && (lower > 0 || m_ > 0) && (std::isfinite(upper) || m_ < 0),
                           "PowerLawDistribution",
                           {{"exponent", exponent}, {"lower", lower}, {"upper", upper}},
                           "0 <= lower < upper, lower above zero unless exponent > -1, and upper finite "
                           "unless exponent < -1");
    }
    double lower() const { return lower_; }
    double upper() const { return upper_; }
    // Infinite at 0 for an exponent below 0.
    double pdf(double x) const {
        if (!(x >= lower_ && x <= upper_)) return 0;
        if (m_ == 0) return 1 / (x * span_);
        double end = m_ < 0 ? lower_ : upper_; // the end where x^m is largest
        return std::abs(m_) / end * std::pow(x / end, m_ - 1) / -std::expm1(-std::abs(m_) * span_);
    }
    double cdf(double x) const {
        if (!(x > lower_)) return 0;
        if (!(x < upper_)) return 1;
        if (m_ == 0) return above_lower(x) / span_;
        if (m_ < 0) return std::expm1(m_ * above_lower(x)) / std::expm1(m_ * span_);
        return std::exp(-m_ * below_upper(x)) * std::expm1(-m_ * above_lower(x)) / std::expm1(-m_ * span_);
    }
    double cdf_complement(double x) const {
        if (!(x > lower_)) return 1;
        if (!(x < upper_)) return 0;
        if (m_ == 0) return below_upper(x) / span_;
        if (m_ > 0) return std::expm1(-m_ * below_upper(x)) / std::expm1(-m_ * span_);
        return std::exp(m_ * above_lower(x)) * std::expm1(m_ * below_upper(x)) / std::expm1(m_ * span_);
    }
    double quantile(double xi) const { return m_ > 0 ? from_upper(1 - xi, xi) : from_lower(xi, 1 - xi); }
    double quantile_complement(double q) const {
        return m_ > 0 ? from_upper(q, 1 - q) : from_lower(1 - q, q);
    }

  private:
    // ln(x / lower) and ln(upper / x).
    double above_lower(double x) const {
        if (!(lower_ > 0)) return std::numeric_limits<double>::infinity();
        return x < 2 * lower_ ? std::log1p((x - lower_) / lower_) : std::log(x) - std::log(lower_);
    }
    double below_upper(double x) const {
        return 2 * x > upper_ ? -std::log1p((x - upper_) / upper_) : std::log(upper_) - std::log(x);
    }
    // The x with probability p below and q = 1 - p above; the smaller of the two is the one that has digits.
    double from_lower(double p, double q) const {
        if (p <= 0) return lower_;
        if (q <= 0) return upper_;
        if (m_ == 0) return p < q ? lower_ * std::exp(p * span_) : upper_ * std::exp(-q * span_);
        double shrink = std::expm1(m_ * span_);
        double log_power = p < q ? std::log1p(p * shrink) : std::log((1 + shrink) - q * shrink);
        return clamped(lower_ * std::exp(log_power / m_));
    }
    double from_upper(double q, double p) const {
        if (p <= 0) return lower_;
        if (q <= 0) return upper_;
        double shrink = std::expm1(-m_ * span_);
        double log_power = q < p ? std::log1p(q * shrink) : std::log((1 + shrink) - p * shrink);
        return clamped(upper_ * std::exp(log_power / m_));
    }
    double clamped(double x) const { return x < lower_ ? lower_ : (x > upper_ ? upper_ : x); }

    double m_, lower_, upper_, span_; // span_ = ln(upper / lower)
};

} // namespace montelux
