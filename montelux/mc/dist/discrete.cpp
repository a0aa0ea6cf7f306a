#include "montelux/mc/dist/discrete.h"

#include "montelux/mc/dist/weights.h"
#include "montelux/mc/math/compensated.h"

namespace montelux {

DiscreteDistribution::DiscreteDistribution(std::span<const double> weights)
    : weight_sum_(checked_weight_sum("DiscreteDistribution", weights)) {
    std::size_t n = weights.size();
    cdf_.resize(n + 1);
    CompensatedSum sum;
    std::size_t last = 0;
    for (std::size_t i = 0; i < n; ++i) {
        double w = weight_sum_ > 0 ? weights[i] / weight_sum_ : 1 / static_cast<double>(n);
        sum.add(w);
        if (w > 0) last = i;
        cdf_[i + 1] = std::min(1.0, std::max(cdf_[i], sum.value()));
    }
    // The last index that can be drawn ends at exactly 1, whatever the rounding was.
    for (std::size_t i = last; i < n; ++i) cdf_[i + 1] = 1;
}

} // namespace montelux
