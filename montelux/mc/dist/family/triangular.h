// The triangular distribution.
#pragma once

#include <algorithm>
#include <cmath>

#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/dist/parameters.h"

namespace montelux {

// p rises linearly from 0 at lower to 2 / (upper - lower) at mode, and falls to 0 at upper:
// X = lower + sqrt(xi (upper - lower) (mode - lower)) left of the mode, and its mirror image right of it.
class TriangularDistribution : public SampledByInversion<TriangularDistribution> {
  public:
    explicit TriangularDistribution(double lower = 0, double mode = 0.5, double upper = 1)
        : lower_(lower), mode_(mode), upper_(upper), width_(upper - lower) {
        require_parameters(lower < upper && lower <= mode && mode <= upper && std::isfinite(width_),
                           "TriangularDistribution", {{"lower", lower}, {"mode", mode}, {"upper", upper}},
                           "lower <= mode <= upper, all finite, and lower < upper");
    }
    double lower() const { return lower_; }
    double upper() const { return upper_; }
    double pdf(double x) const {
        if (!(x >= lower_ && x <= upper_)) return 0;
        if (x == mode_) return 2 / width_;
        double slope = x < mode_ ? (x - lower_) / (mode_ - lower_) : (upper_ - x) / (upper_ - mode_);
        return 2 * slope / width_;
    }
    double cdf(double x) const {
        if (x <= lower_) return 0;
        return x < mode_ ? below(x) : 1 - above(std::min(x, upper_));
    }
    double cdf_complement(double x) const {
        if (x >= upper_) return 0;
        return x > mode_ ? above(x) : 1 - below(std::max(x, lower_));
    }
    double quantile(double xi) const { return point(xi, 1 - xi); }
    double quantile_complement(double q) const { return point(1 - q, q); }

  private:
    // Left and right of the mode.
    double below(double x) const {
        return mode_ > lower_ ? (x - lower_) / width_ * ((x - lower_) / (mode_ - lower_)) : 0;
    }
    double above(double x) const {
        return upper_ > mode_ ? (upper_ - x) / width_ * ((upper_ - x) / (upper_ - mode_)) : 0;
    }
    double point(double p, double q) const {
        if (p * width_ < mode_ - lower_) return lower_ + std::sqrt(p * width_ * (mode_ - lower_));
        return upper_ - std::sqrt(q * width_ * (upper_ - mode_));
    }

    double lower_, mode_, upper_, width_;
};

} // namespace montelux
