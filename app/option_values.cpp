#include "app/option_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string_view>

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

double parse_duration(const std::string& option, const std::string& s) {
    const char *at = s.data(), *end = s.data() + s.size();
    double seconds = 0, last_unit = 1e9;
    bool good = at != end;
    while (good && at != end) {
        double v = 0, unit = 1;
        auto [stop, error] = std::from_chars(at, end, v);
        good = error == std::errc() && v >= 0 && std::isfinite(v);
        if (!good) break;
        if (stop != end) unit = *stop == 'h' ? 3600 : *stop == 'm' ? 60 : *stop == 's' ? 1 : 0;
        // A bare number is seconds, and stands alone.
        good = unit > 0 && unit < last_unit && !(stop == end && last_unit < 1e9);
        last_unit = unit;
        seconds += v * unit;
        at = stop == end ? end : stop + 1;
    }
    if (!good) refuse(option, s, "a time is expected, for example 90, 90s, 10m or 1h30m");
    return seconds;
}
double parse_time_limit(const std::string& option, const std::string& s) {
    const double seconds = parse_duration(option, s);
    if (!(seconds > 0)) refuse(option, s, "a time above 0 is expected, for example 90, 90s, 10m or 1h30m");
    return seconds;
}

std::size_t parse_size(const std::string& option, const std::string& s, std::size_t lowest) {
    const std::string_view units = "KMGT";
    const std::size_t unit = s.empty() ? std::string_view::npos : units.find(s.back());
    const bool has_unit = unit != std::string_view::npos;
    const auto v = number(s, s.size() - (has_unit ? 1 : 0));
    const double bytes = v.value_or(-1) * std::exp2(has_unit ? 10 * static_cast<double>(unit + 1) : 0);
    // Larger ones than any address mean the same.
    if (!v || !(bytes >= static_cast<double>(lowest)))
        refuse(option, s,
               "a size from " + std::to_string(lowest >> 20) + "M on is expected, for example 500M or 2G");
    return static_cast<std::size_t>(std::min(bytes, 0x1p60));
}

std::uint64_t parse_whole_number(const std::string& option, const std::string& s, std::uint64_t lowest,
                                 std::uint64_t highest) {
    std::uint64_t v = 0;
    const char* end = s.data() + s.size();
    const auto [stop, error] = std::from_chars(s.data(), end, v);
    bool good = error == std::errc() && stop == end;
    // Doubles hold whole numbers up to 2^53.
    if (const auto d = number(s, s.size()); !good && d && *d >= 0 && *d <= 0x1p53 && *d == std::floor(*d)) {
        v = static_cast<std::uint64_t>(*d);
        good = !s.starts_with('-');
    }
    if (!good || v < lowest || v > highest)
        refuse(option, s,
               highest == UINT64_MAX ? "a whole number is expected, at least " + std::to_string(lowest)
                                     : "a whole number from " + std::to_string(lowest) + " to " +
                                           std::to_string(highest) + " is expected");
    return v;
}

CLI::Validator number_within(double lower, double upper) {
    auto check = [lower, upper](std::string& s) -> std::string {
        const auto v = number(s, s.size());
        if (v && *v >= lower && *v <= upper) return "";
        char text[96];
        std::snprintf(text, sizeof text, "' was given; a number from %g to %g is expected", lower, upper);
        return "'" + s + text;
    };
    return {check, ""};
}

CLI::Validator file_name() {
    return {[](std::string& s) -> std::string { return s.empty() ? "the name of a file is expected" : ""; },
            ""};
}

} // namespace montelux::app
