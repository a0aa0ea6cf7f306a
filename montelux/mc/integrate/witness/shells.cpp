#include "montelux/mc/integrate/witness/shells.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "montelux/mc/integrate/infinity.h"

namespace montelux {
namespace {

constexpr std::size_t shells = 12; // of each of the two ranges that are compared
// Shells of the outer and of the inner range, in units of the finest exponent.
constexpr double outer_from = 0.35, outer_to = 0.5, inner_from = 0.75, inner_to = 1;
// Ratio of the means for masses that fall like 1 / k.
constexpr double harmonic = (outer_from + outer_to) / (inner_from + inner_to);
constexpr double noise = 0.93; // factor for masses that oscillate
// Ratio of the masses of the last third of the inner range and of that before: the least where the whole range does not
// fall, and one that tells by itself, of a pole that the outer range cannot see beside the rest of the integrand.
constexpr double steady_ratio = 0.25, constant_ratio = 0.98;
// Growth of |g| over three octaves towards a pole; four times that for each variable more.
constexpr double least_growth = 3;
constexpr double coarsest = 6; // least exponent of the innermost shells
constexpr double of_digits =
    64; // exponents of zeros by cancellation; farther on intermediate results overflow
// Parts of the exponent at which values are rounded to zero: the last five of 53 digits, and where values are precise to
// 10 and to 21 digits.
constexpr double rounded_part = 0.1, precise = 0.8, coarser = 0.6;
// Second differences of log2 |g|: quanta of rounding give steps of one and less, powers none.
constexpr double rough = 0.2, smooth = 0.05;
constexpr double least_fall = 0.02; // of masses before rounding, for each octave

std::vector<double> exponents(double from, double to) {
    std::vector<double> k;
    for (std::size_t i = 0; i < shells; ++i)
        k.push_back(from + (to - from) * static_cast<double>(i) / static_cast<double>(shells - 1));
    return k;
}

} // namespace

double finest_exponent(const Domain& domain, std::size_t d, double u) {
    if (domain.ranges().empty()) return finest_inside;
    const Range range = domain.ranges()[d];
    const double all = range.upper - range.lower, width = std::isfinite(all) ? all : 1;
    // Towards the lower end coordinates are denser, and so is x towards zero.
    const double of_u = -std::log2(std::min(1.0, 2 * u));
    const bool at_end = u < 0x1p-60 && std::isfinite(range.lower);
    if (!std::isfinite(all) && !at_end) return finest_inside;
    const double x = at_end ? range.lower : range.lower + width * u;
    const double of_x = x == 0 ? of_u : std::log2(width / std::abs(x));
    return std::clamp(finest_inside + std::min(of_u, of_x), 4.0, finest_at_origin);
}

namespace {

// The largest exponent up to `finest` whose value is a number other than zero, and the value beyond it, for values that
// have none from there on.
struct LastValue {
    double exponent, beyond;
};
LastValue last_value(const ShellValues& values, double finest) {
    double known = 0, unknown = finest, beyond = 0;
    constexpr int bisections = 12;
    for (int i = 0; i < bisections; ++i) {
        const std::array<double, 1> middle{0.5 * (known + unknown)};
        const double g = values(middle)[0];
        if (g > 0 && std::isfinite(g)) {
            known = middle[0];
        } else {
            unknown = middle[0];
            beyond = g;
        }
    }
    return {known, beyond};
}

// Second differences of log2 |g| over `window` exponents up to one: the largest, of that sign which has the smaller one.
// Steep slopes have one sign alone, quanta of rounding both.
double roughness(const ShellValues& values, double exponent, double window) {
    constexpr std::size_t points = 65;
    std::vector<double> k(points);
    for (std::size_t i = 0; i < points; ++i)
        k[i] = exponent - window * (1 - static_cast<double>(i) / static_cast<double>(points - 1));
    const std::vector<double> g = values(k);
    double up = 0, down = 0;
    for (std::size_t i = 1; i + 1 < points; ++i) {
        const double difference = std::log2(g[i - 1]) - 2 * std::log2(g[i]) + std::log2(g[i + 1]);
        up = std::max(up, difference);
        down = std::max(down, -difference);
    }
    return std::min(up, down);
}

// Whether cancellation rounds values to zero beyond an exponent, as it does 1 - cos r: they lose their 53 digits at a steady
// rate, so that there they are rough where those at some distance are smooth. What ends in truth is as rough as before.
bool loses_digits(const ShellValues& values, double last) {
    const double window = rounded_part * last;
    return roughness(values, last, window) > rough && roughness(values, precise * last, window) < smooth;
}

// Octaves by which masses fall from one octave of the distance to the next, where values are still precise.
double fall_before(const ShellValues& values, double last, int codimension) {
    const std::array<double, 2> k{coarser * last, precise * last};
    const std::vector<double> g = values(k);
    return codimension + std::log2(g[0] / g[1]) / (k[1] - k[0]);
}

enum class Rounding { unlikely, likely, overflows };

bool masses_diverge_until(const ShellValues& values, double finest, int codimension, Rounding rounding) {
    if (finest < coarsest) return false;
    const std::vector<double> outer = exponents(outer_from * finest, outer_to * finest);
    const std::vector<double> inner = exponents(inner_from * finest, inner_to * finest);
    const std::vector<double> g_outer = values(outer), g_inner = values(inner);
    // Relative to the coarsest inner shell, so that the masses stay within the range of doubles.
    auto mass = [&](double g, double k) { return g * std::exp2(codimension * (outer_to * finest - k)); };
    double sum_outer = 0, sum_inner = 0, innermost = 0, before = 0;
    bool rounded = false;
    for (std::size_t i = 0; i < shells; ++i) {
        rounded = rounded || std::isnan(g_outer[i]) || !std::isfinite(mass(g_inner[i], inner[i])) ||
                  g_inner[i] == 0;
        sum_outer += mass(g_outer[i], outer[i]);
        sum_inner += mass(g_inner[i], inner[i]);
        if (i >= shells - shells / 3)
            innermost += mass(g_inner[i], inner[i]);
        else if (i >= shells / 3)
            before += mass(g_inner[i], inner[i]);
    }
    // Infinite, zero or no number, by overflow or rounding: the shells up to there tell.
    if (rounded) {
        if (rounding == Rounding::unlikely) return false;
        const auto [last, beyond] = last_value(values, finest);
        if (beyond != 0 || (rounding == Rounding::overflows && last > of_digits))
            return masses_diverge_until(values, last, codimension, Rounding::unlikely);
        return loses_digits(values, last) && fall_before(values, last, codimension) < least_fall;
    }
    // Values that no longer grow are those of a narrow peak. Over three octaves those of a pole grow by 8^codimension or
    // more, but for oscillations.
    const double last = std::max(g_inner[shells - 1], g_inner[shells - 2]),
                 earlier = std::max(g_inner[shells - 4], g_inner[shells - 5]);
    const double octaves = std::min(3.0, inner[shells - 1] - inner[shells - 4]);
    const double growth = std::pow(least_growth * std::exp2(2 * (codimension - 1)), octaves / 3);
    // Within the inner range, too: the outer one may lie beyond all that is there.
    if (!(sum_inner > 0 && last >= growth * earlier)) return false;
    return innermost >= (sum_inner >= noise * harmonic * sum_outer ? steady_ratio : constant_ratio) * before;
}

} // namespace

double mass_of_lost_digits(const ShellValues& values, double finest, int codimension) {
    const auto [last, beyond] = last_value(values, finest);
    if (beyond != 0 || !loses_digits(values, last)) return 0;
    const double fall = fall_before(values, last, codimension);
    if (fall < least_fall) return infinity;
    const std::array<double, 1> k{precise * last};
    return codimension * values(k)[0] * std::exp2(-codimension * k[0] - fall * (last - k[0])) / fall;
}

bool masses_diverge(const ShellValues& values, double finest, int codimension, bool overflows) {
    return masses_diverge_until(values, finest, codimension,
                                overflows ? Rounding::overflows : Rounding::likely);
}

} // namespace montelux
