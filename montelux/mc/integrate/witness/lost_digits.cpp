#include "montelux/mc/integrate/witness/lost_digits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "montelux/mc/integrate/infinity.h"

namespace montelux {
namespace {

// Parts of the exponent at which values are rounded to zero: the last five of 53 digits, and where values are precise to
// 21 digits.
constexpr double rounded_part = 0.1, coarser = 0.6;
// Second differences of log2 |g|: quanta of rounding give steps of one and less, powers none.
constexpr double rough = 0.2, smooth = 0.05;
constexpr double sudden = 2;        // factor of a drop from one value to the next
constexpr double least_fall = 0.02; // of masses before rounding, for each octave
// Distances of points between which noise is as rough, in octaves.
constexpr double near = 0x1p-14, wide = 0x1p-8;
// Exponents at which noise is searched for: that of terms which cancel to second order or more lasts for as many octaves as
// lead to it, or more.
constexpr double first_probe = 1.5, last_probe = 64, next_probe = 1.5;

// log2 |g| at so many exponents up to one, and their second differences.
std::vector<double> second_differences(const ShellValues& values, double exponent, double step,
                                       std::size_t points) {
    std::vector<double> k(points), differences;
    for (std::size_t i = 0; i < points; ++i) k[i] = exponent - step * static_cast<double>(points - 1 - i);
    const std::vector<double> g = values(k);
    for (std::size_t i = 1; i + 1 < points; ++i) {
        const bool zero = g[i - 1] == 0 && g[i] == 0 && g[i + 1] == 0;
        differences.push_back(zero ? 0 : std::log2(g[i - 1]) - 2 * std::log2(g[i]) + std::log2(g[i + 1]));
    }
    return differences;
}

// Second differences over `window` exponents up to one: the largest, of that sign which has the smaller one. Steep slopes
// have one sign alone, quanta of rounding both.
double roughness(const ShellValues& values, double exponent, double window) {
    constexpr std::size_t points = 65;
    double up = 0, down = 0;
    for (double difference :
         second_differences(values, exponent, window / static_cast<double>(points - 1), points)) {
        up = std::max(up, difference);
        down = std::max(down, -difference);
    }
    return std::min(up, down);
}

// The median of second differences, whatever their sign: jumps are few. Zeros among other values count as the roughest.
double noise_at(const ShellValues& values, double exponent, double step, std::size_t points = 9) {
    std::vector<double> sizes = second_differences(values, exponent, step, points);
    for (double& size : sizes) size = std::isnan(size) ? infinity : std::abs(size);
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::ranges::nth_element(sizes, middle);
    return *middle;
}

// Octaves by which masses fall from one octave of the distance to the next, where values are still precise.
double fall_before(const ShellValues& values, double last, int codimension) {
    const std::array<double, 2> k{coarser * last, precise * last};
    const std::vector<double> g = values(k);
    return codimension + std::log2(g[0] / g[1]) / (k[1] - k[0]);
}

// Whether cancellation rounds values to zero beyond an exponent, as it does 1 - cos r: they lose their 53 digits at a steady
// rate, so that there they are rough where those at some distance are smooth. What ends in truth is as rough as before.
bool is_rounded_to_zero(const ShellValues& values, double last) {
    const double window = rounded_part * last;
    return roughness(values, last, window) > rough && roughness(values, precise * last, window) < smooth;
}

} // namespace

LastValue last_value(const ShellValues& values, double from, double to, double floor, int bisections) {
    double known = from, unknown = to, value = 0, beyond = 0;
    for (int i = 0; i < bisections; ++i) {
        const std::array<double, 1> middle{0.5 * (known + unknown)};
        const double g = values(middle)[0];
        if (g > floor && std::isfinite(g)) {
            known = middle[0];
            value = g;
        } else {
            unknown = middle[0];
            beyond = g;
        }
    }
    return {known, value, beyond};
}

double noise_from(const ShellValues& values, double finest) {
    double before = 0, at = first_probe;
    for (; at <= std::min(finest, last_probe); at *= next_probe) {
        if (noise_at(values, at, wide) > smooth) break;
        before = at;
    }
    if (before == 0 || at > std::min(finest, last_probe)) return infinity;
    // Steps, since an oscillation may look smooth farther in, by aliasing.
    constexpr int steps = 8;
    const double step = (at - before) / steps;
    for (at = before + step; !(noise_at(values, at, wide) > rough) && at < before + steps * step;) at += step;
    constexpr double further = 1.1; // where noise leaves no doubt
    constexpr std::size_t points = 17;
    const bool is_noise =
        noise_at(values, further * at, near, points) > rough && noise_at(values, precise * at, wide) < smooth;
    return is_noise ? at : infinity;
}

double digits_lost_from(const ShellValues& values, double last) {
    return is_rounded_to_zero(values, last) ? last : noise_from(values, last);
}

double mass_beyond(const ShellValues& values, double last, int codimension, double until) {
    const double fall = fall_before(values, last, codimension);
    if (until <= last) return 0;
    if (until == infinity && fall < least_fall) return infinity;
    const std::array<double, 1> k{precise * last};
    const double sum = fall == 0 ? std::numbers::ln2 * (until - last)
                                 : -std::expm1(-std::numbers::ln2 * fall * (until - last)) / fall;
    return codimension * values(k)[0] * std::exp2(-codimension * k[0] - fall * (last - k[0])) * sum;
}

double mass_of_lost_digits(const ShellValues& values, double from, double to, int codimension, double until) {
    const std::array<double, 1> k{from};
    constexpr int bisections = 7; // few, since most peaks drop smoothly
    const LastValue last = last_value(values, from, to, values(k)[0] / sudden, bisections);
    if (!std::isfinite(last.beyond) || !(last.value > sudden * last.beyond)) return 0;
    const double lost = digits_lost_from(values, last.exponent);
    return lost < infinity ? mass_beyond(values, lost, codimension, until) : 0;
}

} // namespace montelux
