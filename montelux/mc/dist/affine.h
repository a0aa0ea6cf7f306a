// A distribution shifted, scaled or reflected.
#pragma once

#include <cmath>
#include <utility>

#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/dist/parameters.h"

namespace montelux {

// The law of Y = shift + scale X with X from D; scale < 0 reflects. The density is p((y - shift) / scale) /
// |scale|.
template <Distribution1D D>
class Affine : public SampledByInversion<Affine<D>> {
  public:
    Affine(D distribution, double scale, double shift)
        : d_(std::move(distribution)), scale_(scale), shift_(shift) {
        require_parameters(scale != 0 && std::isfinite(scale) && std::isfinite(shift), "Affine",
                           {{"scale", scale}, {"shift", shift}},
                           "a finite scale that is not zero and a finite shift");
    }
    double lower() const { return forward(scale_ > 0 ? d_.lower() : d_.upper()); }
    double upper() const { return forward(scale_ > 0 ? d_.upper() : d_.lower()); }
    double pdf(double y) const { return d_.pdf(back(y)) / std::abs(scale_); }
    double cdf(double y) const {
        return scale_ > 0 ? d_.cdf(back(y)) : montelux::cdf_complement(d_, back(y));
    }
    double cdf_complement(double y) const {
        return scale_ > 0 ? montelux::cdf_complement(d_, back(y)) : d_.cdf(back(y));
    }
    double quantile(double xi) const {
        return forward(scale_ > 0 ? d_.quantile(xi) : montelux::quantile_complement(d_, xi));
    }
    double quantile_complement(double q) const {
        return forward(scale_ > 0 ? montelux::quantile_complement(d_, q) : d_.quantile(q));
    }

  private:
    double forward(double x) const { return shift_ + scale_ * x; }
    double back(double y) const { return (y - shift_) / scale_; }

    D d_;
    double scale_, shift_;
};

template <Distribution1D D>
Affine<D> shifted(D distribution, double shift) {
    return {std::move(distribution), 1, shift};
}
template <Distribution1D D>
Affine<D> scaled(D distribution, double scale) {
    return {std::move(distribution), scale, 0};
}
// The law of -X.
template <Distribution1D D>
Affine<D> reflected(D distribution) {
    return {std::move(distribution), -1, 0};
}

} // namespace montelux
