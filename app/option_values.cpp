#include "app/option_values.h"

#include <charconv>
#include <cmath>
#include <optional>

namespace montelux::app {

namespace {

std::optional<double> number(const std::string& s, std::size_t length) {
    double v = 0;
    auto [stop, error] = std::from_chars(s.data(), s.data() + length, v);
    if (error != std::errc() || stop != s.data() + length || !std::isfinite(v)) return std::nullopt;
    return v;
}

} // namespace

void refuse(const std::string& option, const std::string& given, const std::string& expected) {
    throw CLI::ValidationError(option, "'" + given + "' was given; " + expected);
}

double parse_not_negative(const std::string& option, const std::string& s) {
    const auto v = number(s, s.size());
    if (!v || *v < 0) refuse(option, s, "a number that is not negative is expected");
    return *v;
}

double parse_positive(const std::string& option, const std::string& s) {
    const auto v = number(s, s.size());
    if (!v || *v <= 0) refuse(option, s, "a number above 0 is expected");
    return *v;
}

double parse_share(const std::string& option, const std::string& s) {
    const bool percent = s.ends_with('%');
    const auto v = number(s, s.size() - (percent ? 1 : 0));
    const double share = v.value_or(0) * (percent ? 0.01 : 1);
    if (!(share > 0 && share < 1))
        refuse(option, s, "a number above 0 and below 1 is expected, or above 0% and below 100%");
    return share;
}

} // namespace montelux::app
