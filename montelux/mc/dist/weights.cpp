#include "montelux/mc/dist/weights.h"

#include <cmath>
#include <sstream>
#include <string>

#include "montelux/mc/math/compensated.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

template <typename T>
double check(std::string_view where, std::span<const T> weights) {
    if (weights.empty()) throw Error(where, "expected at least one weight, found none");
    CompensatedSum sum;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        double w = static_cast<double>(weights[i]);
        if (!(w >= 0) || std::isinf(w)) {
            std::ostringstream what;
            what << "weight " << i << " of " << weights.size() << " is " << w
                 << "; expected a finite number that is not negative";
            throw Error(where, what.str());
        }
        sum.add(w);
    }
    if (!std::isfinite(sum.value())) throw Error(where, "the sum of the weights overflows");
    return sum.value();
}

} // namespace

double checked_weight_sum(std::string_view where, std::span<const float> weights) {
    return check(where, weights);
}
double checked_weight_sum(std::string_view where, std::span<const double> weights) {
    return check(where, weights);
}

} // namespace montelux
