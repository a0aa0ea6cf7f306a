#include "montelux/mc/integrate/witness/shells.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/integrate/witness/lost_digits.h"

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
constexpr double flat = 0.01;  // relative difference of values that do not grow
constexpr double coarsest = 6; // least exponent of the innermost shells
constexpr double of_digits =
    64; // exponents of zeros by cancellation; farther on intermediate results overflow

std::vector<double> exponents(double from, double to) {
    std::vector<double> k;
    for (std::size_t i = 0; i < shells; ++i)
        k.push_back(from + (to - from) * static_cast<double>(i) / static_cast<double>(shells - 1));
    return k;
}

} // namespace

double finest_exponent(const Domain& domain, std::size_t d, double u) {
    if (domain.ranges().empty()) return u < 0x1p-60 ? finest_at_origin : finest_inside;
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

enum class Rounding { unlikely, likely, overflows };

bool masses_diverge_until(const ShellValues& values, double finest, int codimension, Rounding rounding,
                          double until) {
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
        const auto [last, value, beyond] = last_value(values, 0, finest);
        if (beyond != 0 || (rounding == Rounding::overflows && last > of_digits))
            return masses_diverge_until(values, last, codimension, Rounding::unlikely, until);
        const double lost = digits_lost_from(values, last);
        return lost < infinity && std::isinf(mass_beyond(values, lost, codimension, until));
    }
    // Values that no longer grow are those of a narrow peak. Over three octaves those of a pole grow by 8^codimension or
    // more, but for oscillations.
    const double last = std::max(g_inner[shells - 1], g_inner[shells - 2]),
                 earlier = std::max(g_inner[shells - 4], g_inner[shells - 5]);
    const double octaves = std::min(3.0, inner[shells - 1] - inner[shells - 4]);
    const double growth = std::pow(least_growth * std::exp2(2 * (codimension - 1)), octaves / 3);
    // Within the inner range, too: the outer one may lie beyond all that is there.
    if (!(sum_inner > 0 && last >= growth * earlier)) return false;
    // A jump has constant values on both sides.
    const auto is_flat = [&](std::size_t i) { return std::abs(g_inner[i] / g_inner[i - 1] - 1) < flat; };
    if (is_flat(shells - 1) && is_flat(shells - 5)) return false;
    return innermost >= (sum_inner >= noise * harmonic * sum_outer ? steady_ratio : constant_ratio) * before;
}

} // namespace

bool masses_diverge(const ShellValues& values, double finest, int codimension, bool overflows, double until) {
    if (!masses_diverge_until(values, finest, codimension, overflows ? Rounding::overflows : Rounding::likely,
                              until))
        return false;
    const double from = noise_from(values, finest);
    return from == infinity || std::isinf(mass_beyond(values, from, codimension, until));
}

} // namespace montelux
