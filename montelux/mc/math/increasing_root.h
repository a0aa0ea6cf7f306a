// The root of an increasing function in a bracket, for numerical quantiles.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

namespace montelux {

// A point strictly between lo and hi that halves the number of floating-point numbers between them rather
// than their distance, where they differ in magnitude; lo < hi, both finite.
inline double bracket_middle(double lo, double hi) {
    double middle = 0.5 * lo + 0.5 * hi;
    if (lo < 0 && hi > 0) return middle;
    double near = std::min(std::abs(lo), std::abs(hi)), far = std::max(std::abs(lo), std::abs(hi));
    if (far <= 16 * near) return middle;
    double magnitude = near > 0 ? std::sqrt(near) * std::sqrt(far) : far * 0x1p-20;
    return std::copysign(magnitude, hi > 0 ? hi : lo);
}

// residual(x) gives the pair (value, slope) of a function that does not decrease from lo to hi, is at most 0
// at lo and at least 0 at hi. Newton steps from `start`; a step that leaves the bracket, or does not halve
// the step before, gives way to halving the bracket. Ends with the Newton step that is shorter than
// `tolerance` times x, whose own error is far smaller where the slope is smooth, or where halving ends.
template <typename Residual>
double increasing_root(double lo, double hi, double start, const Residual& residual,
                       double tolerance = 1e-14) {
    double x = std::clamp(start, lo, hi), last_step = hi - lo;
    for (int i = 0; i < 400; ++i) {
        auto [value, slope] = residual(x);
        if (value == 0) return x;
        (value > 0 ? hi : lo) = x;
        double step = -value / slope, next = x + step;
        bool newton = next > lo && next < hi && std::abs(step) <= 0.5 * last_step;
        if (!newton) {
            next = bracket_middle(lo, hi);
            step = next - x;
            if (!(next > lo && next < hi)) return x;
        }
        if (newton && std::abs(step) <= tolerance * std::abs(next)) return next;
        last_step = std::abs(step);
        x = next;
    }
    return x;
}

} // namespace montelux
