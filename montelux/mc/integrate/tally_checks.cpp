#include "montelux/mc/integrate/tally_checks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>

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

std::string point_text(const std::vector<double>& point) {
    std::ostringstream text;
    text.precision(17);
    text << "(";
    constexpr std::size_t most = 8;
    for (std::size_t d = 0; d < std::min(most, point.size()); ++d) text << (d ? ", " : "") << point[d];
    text << (point.size() > most ? ", ...)" : ")");
    return text.str();
}

bool is_rounding(const Tally& tally) {
    for (std::size_t c = 0; c < tally.value.size(); ++c)
        if (tally.value[c] == 0 ||
            !(tally.standard_error[c] <= std::numeric_limits<double>::epsilon() * std::abs(tally.value[c])))
            return false;
    return true;
}

} // namespace montelux
