#include "montelux/mc/integrate/tally_checks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace montelux {

bool meets(const Tally& tally, const StepRequest& request) {
    for (std::size_t c = 0; c < tally.value.size(); ++c)
        if (!(tally.standard_error[c] <= request.tolerance(c, tally.value[c]))) return false;
    return true;
}

bool nothing_found(const Tally& tally) {
    if (!tally.statistical || tally.evaluations == 0) return false;
    for (std::size_t c = 0; c < tally.value.size(); ++c)
        if (tally.value[c] == 0 && tally.standard_error[c] == 0) return true;
    return false;
}

bool is_rounding(const Tally& tally) {
    for (std::size_t c = 0; c < tally.value.size(); ++c)
        if (tally.value[c] == 0 ||
            !(tally.standard_error[c] <= std::numeric_limits<double>::epsilon() * std::abs(tally.value[c])))
            return false;
    return true;
}

} // namespace montelux
