#include "montelux/mc/stats/estimate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>

#include "montelux/mc/math/special.h"

namespace montelux {
namespace {

std::string formatted(const char* format, int precision, double v) {
    char buffer[512];
    std::snprintf(buffer, sizeof buffer, format, precision, v);
    return buffer;
}

int decimal_exponent(double v) {
    // Through the printed form, which rounds like the final one.
    std::string s = formatted("%.*e", 1, v);
    return std::stoi(s.substr(s.find('e') + 1));
}

std::string with_error(double value, double error) {
    int last = decimal_exponent(error) - 1; // power of ten of the second digit of the error
    int first = std::max(value == 0 ? last : decimal_exponent(std::abs(value)), last + 1);
    int shift = first > 5 || first < -4 || last > 0 ? first : 0;
    // Divide by a power that is exact for the sizes in use; 10^-k is not.
    auto scaled = [&](double v) {
        return shift > 0 ? v / std::pow(10.0, shift) : v * std::pow(10.0, -shift);
    };
    int decimals = std::max(0, shift - last);
    double digits = std::round(last > 0 ? error / std::pow(10.0, last) : error * std::pow(10.0, -last));
    std::string s = formatted("%.*f", decimals, scaled(value)) + "(" + formatted("%.*f", 0, digits) + ")";
    return shift == 0 ? s : s + "e" + std::to_string(shift);
}

} // namespace

Interval Estimate::confidence_interval(double level) const {
    double half = normal_quantile(0.5 + 0.5 * level) * standard_error;
    return {value - half, value + half};
}

std::string to_string(const Estimate& e) {
    std::string s;
    if (std::isfinite(e.value) && std::isfinite(e.standard_error) && e.standard_error > 0)
        s = with_error(e.value, e.standard_error);
    else if (e.standard_error == 0)
        s = formatted("%.*g", 17, e.value) + "(0)";
    else
        s = formatted("%.*g", 6, e.value) + "(?)";
    if (e.non_finite > 0) s += " [" + std::to_string(e.non_finite) + " non-finite]";
    return s;
}

std::ostream& operator<<(std::ostream& out, const Estimate& estimate) { return out << to_string(estimate); }

} // namespace montelux
