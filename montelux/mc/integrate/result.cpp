#include "montelux/mc/integrate/result.h"

#include <array>
#include <cstdio>
#include <ostream>

namespace montelux {

std::string_view to_string(StopReason reason) {
    static constexpr std::array<std::string_view, 6> names{"error_target", "evaluations", "time",
                                                           "interrupted",  "diverges",    "finished"};
    return names[static_cast<std::size_t>(reason)];
}

Estimate IntegrationResult::estimate(int component) const {
    const auto c = static_cast<std::size_t>(component);
    return {value.at(c), standard_error.at(c), evaluations, non_finite};
}

std::string to_string(const IntegrationResult& result) {
    std::string text;
    for (std::size_t c = 0; c < result.value.size(); ++c) {
        Estimate one = result.estimate(static_cast<int>(c));
        one.non_finite = 0; // said once, below
        text += to_string(one) + "\n";
    }
    text += std::to_string(result.evaluations) + " evaluations by " + result.method;
    if (!result.reason.empty() && result.stop != StopReason::diverges) text += " (" + result.reason + ")";
    switch (result.stop) {
    case StopReason::error_target:
        text += result.converged() ? ", error target reached" : ", error target reached, but with a warning";
        break;
    case StopReason::evaluations:
        text += ", stopped at the number of evaluations";
        break;
    case StopReason::time:
        text += ", stopped by time";
        break;
    case StopReason::interrupted:
        text += ", interrupted";
        break;
    case StopReason::diverges:
        text += ", stopped: no integral was found";
        break;
    case StopReason::finished:
        text += ", finished";
        break;
    }
    if (result.degrees_of_freedom > 0) {
        std::array<char, 96> buffer;
        std::snprintf(buffer.data(), buffer.size(), "; chi^2/dof %.2f, p = %.2g",
                      result.chi_squared_per_degree(), result.p_value);
        text += buffer.data();
    }
    for (const std::string& note : result.notes) text += "\nnote: " + note;
    for (const std::string& warning : result.warnings) text += "\nwarning: " + warning;
    return text;
}

std::ostream& operator<<(std::ostream& out, const IntegrationResult& result) {
    return out << to_string(result);
}

} // namespace montelux
