#include "montelux/mc/integrate/witness/ladder_masses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "montelux/mc/integrate/witness/lost_digits.h"
#include "montelux/mc/integrate/witness/ridge.h"

namespace montelux {
namespace {

constexpr double least_resolved = 16; // exponent of the finest shell that tells of divergence inside
constexpr double suspicious = 0.2;    // of the inner shells' masses beside the outer ones',
constexpr double constant = 0.9;      // or of the innermost one beside the one before
constexpr double least_left = 0.01;   // of the outer ones: from there on it counts what lies beyond
constexpr double growing = 2;         // factor of |g| from one shell of a ladder to the next, towards a pole
constexpr double same_pole = 0x1p-20; // of the cube's width: digits are lost closer to it

// Whether two paths lead to one side of one pole.
bool is_same(const LadderPath& a, const LadderPath& b) {
    for (std::size_t d = 0; d < a.side.size(); ++d)
        if (a.side[d] != b.side[d] ||
            (a.side[d] != 0 && std::abs(a.anchors[d].u - b.anchors[d].u) > same_pole))
            return false;
    return true;
}

// Do all variables that move go to infinity?
bool goes_to_infinity(const LadderPath& path, const Domain& domain) {
    const std::span<const Range> ranges = domain.ranges();
    if (ranges.empty()) return false;
    for (std::size_t d = 0; d < path.side.size(); ++d)
        if (path.side[d] != 0 && !(path.anchors[d].u == 0 && std::isinf(ranges[d].lower)) &&
            !(path.anchors[d].u == 1 && std::isinf(ranges[d].upper)))
            return false;
    return true;
}

} // namespace

LadderMasses::LadderMasses(RawValues& raw, LadderPaths& paths)
    : raw_(raw), paths_(paths), most_(static_cast<std::size_t>(raw.evaluator().components()), 0.0) {}

bool LadderMasses::see(const std::vector<double>& row, double volume) {
    if (!std::ranges::all_of(row, [](double value) { return std::isfinite(value); })) return false;
    for (std::size_t c = 0; c < row.size(); ++c) most_[c] = std::max(most_[c], std::abs(row[c]) * volume);
    return true;
}

LadderPath LadderMasses::another(LadderPath path) {
    const std::vector<double> through = paths_.generic_point();
    for (std::size_t d = 0; d < path.side.size(); ++d)
        if (path.side[d] == 0) path.anchors[d].u = through[d];
    paths_.vary(path);
    return path;
}

double LadderMasses::noise(const LadderPath& path, Rows rows, std::size_t c) {
    if (!(mass(path, rows, c, 0) > mass(path, rows, c, 1)) || is_negligible(path, rows, c)) return infinity;
    const double from = noise_from(values_along(path, c), path.finest());
    if (from == infinity || path.side.size() == 1) return from;
    const LadderPath other = another(path); // f may be zero along a single line
    return std::max(from, noise_from(values_along(other, c), other.finest()));
}

bool LadderMasses::diverge(const LadderPath& path, Rows rows, std::size_t c, double noise) {
    if (is_suspicious(path, rows, c) && !is_negligible(path, rows, c) && diverge_further(path, c))
        return true;
    double mass = 0;
    if (noise < infinity) {
        mass = mass_beyond(values_along(path, c), noise, path.codimension(), path.end());
        if (std::isinf(mass) && path.codimension() == 1) return true;
    } else if (const Drop drop = drop_by_rounding(path, rows, c); drop.mass > 0) {
        mass = drop.mass;
        if (std::isinf(mass) && !is_negligible(path, rows, c, drop.shell)) return true;
        if (faces_diverge(path, c, drop.shell)) return true;
    }
    if (mass == 0 && path.codimension() == 1) mass = mass_beyond_shells(path, rows, c);
    add_unresolved(path, c, mass);
    return false;
}

// Adds a mass in units of the volume at exponent 0.
void LadderMasses::add_unresolved(const LadderPath& path, std::size_t c, double mass) {
    for (std::size_t d = 0; d < path.side.size(); ++d)
        if (path.side[d] != 0) mass *= path.reach[d] * off_grid;
    if (!(mass > 0) || std::isinf(mass)) return;
    unresolved_.resize(static_cast<std::size_t>(raw_.evaluator().components()), 0.0);
    const auto known = std::ranges::find_if(
        added_, [&](const Added& added) { return added.component == c && is_same(added.path, path); });
    if (known == added_.end()) {
        added_.push_back({path, c, mass});
        unresolved_[c] += mass;
    } else if (mass > known->mass) {
        unresolved_[c] += mass - known->mass;
        known->mass = mass;
    }
}

void LadderMasses::add_unresolved(const Witness& part, double times) {
    unresolved_.resize(part.value.size(), 0.0);
    for (std::size_t c = 0; c < part.value.size(); ++c)
        unresolved_[c] += times * std::abs(part.value[c]) * part.volume;
}

LadderMasses::Drop LadderMasses::drop_by_rounding(const LadderPath& path, Rows rows, std::size_t c) {
    constexpr double far_out = 0.5; // exponent outside of the ladder
    if (!path.rates.empty()) return {};
    const ShellValues values = values_along(path, c);
    const auto value = [&](double exponent) { return values(std::array<double, 1>{exponent})[0]; };
    for (std::size_t i = ladder.size(); i-- > 0;) {
        const double g = std::abs(rows[i][c]);
        const bool is_last = i + 1 == ladder.size();
        if (i == 0 && rows[1][c] != 0) continue;
        if (!is_last && !(g > growing * std::abs(rows[i + 1][c]))) continue;
        if (!(g > growing * (i > 0 ? std::abs(rows[i - 1][c]) : value(far_out)))) continue;
        if (is_last && !(g > growing * value(std::min(beyond_digits, path.finest())))) continue;
        if (const double mass = mass_of_rounding(path, c, i); mass > 0) return {i, mass};
    }
    return {};
}

// Mass beyond a drop after a shell, in units of the volume at exponent 0.
double LadderMasses::mass_of_rounding(const LadderPath& path, std::size_t c, std::size_t shell) {
    const double from = path.exponent(shell), to = shell + 1 < ladder.size()
                                                       ? path.exponent(shell + 1)
                                                       : std::min(beyond_digits, path.finest());
    const double mass = mass_of_lost_digits(values_along(path, c), from, to, path.codimension(), path.end());
    if (mass < infinity || path.codimension() == 1) return mass;
    LadderPath other = path; // a diagonal may be a ridge
    paths_.vary(other);
    return mass_of_lost_digits(values_along(other, c), from, to, path.codimension());
}

// Adds what is rounded to zero on faces and edges that meet at a place, or planes through it: some variables move and the others
// are generic. Whether masses do not fall there.
bool LadderMasses::faces_diverge(const LadderPath& path, std::size_t c, std::size_t shell) {
    constexpr std::size_t most_variables = 3, most_places = 4;
    const std::size_t n = path.side.size();
    if (path.codimension() != static_cast<int>(n) || n == 1 || n > most_variables) return false;
    if (places_of_faces_ == most_places) return false;
    ++places_of_faces_;
    const std::vector<double> through = paths_.generic_point();
    for (unsigned moving = 1; moving + 1 < 1U << n; ++moving) {
        LadderPath face = path;
        for (std::size_t d = 0; d < n; ++d)
            if ((moving >> d & 1) == 0) {
                face.side[d] = 0;
                face.anchors[d].u = through[d];
            }
        const double mass = mass_of_rounding(face, c, shell);
        if (std::isinf(mass)) return true;
        add_unresolved(face, c, mass);
    }
    return false;
}

// Mass closer to a place, or farther out, than the shells of a path of one variable, in units of the distance at exponent 0:
// at infinity by shells farther out, else what the innermost ones leave if they fall by a power.
double LadderMasses::mass_beyond_shells(const LadderPath& path, Rows rows, std::size_t c) {
    if (path.finest() > finest_inside || !falls_less_than(least_left, path, rows, c)) return 0;
    const double from = path.exponent(3), to = path.exponent(5);
    const double outer = std::abs(rows[3][c]) * std::exp2(-from),
                 inner = std::abs(rows[5][c]) * std::exp2(-to);
    if (goes_to_infinity(path, raw_.evaluator().domain())) return inner * mass_farther_out(path, c, to);
    const double fall = std::log2(outer / inner) / (to - from); // 1 - power
    return fall > 0 && fall < 0.9 ? inner / fall : 0;
}

std::size_t LadderMasses::last_shell(Rows rows, std::size_t c) {
    std::size_t last = ladder.size() - 1;
    while (last > 1 && rows[last][c] == 0) --last;
    return last;
}

// Mass of the shell so many before the last one.
double LadderMasses::mass(const LadderPath& path, Rows rows, std::size_t c, std::size_t before) {
    const std::size_t last = last_shell(rows, c), i = std::max(last, before) - before;
    const double g = std::abs(rows[i][c]);
    return std::isnan(g) || rows[last][c] == 0 ? 0 : g * std::exp2(-path.codimension() * path.exponent(i));
}

// Whether the larger mass of the last two shells is at least a part of that of the two before.
bool LadderMasses::falls_less_than(double part, const LadderPath& path, Rows rows, std::size_t c) {
    const double inner = std::max(mass(path, rows, c, 0), mass(path, rows, c, 1)),
                 outer = std::max(mass(path, rows, c, 2), mass(path, rows, c, 3));
    return inner > 0 && (std::isinf(inner) || inner >= part * outer);
}

bool LadderMasses::is_suspicious(const LadderPath& path, Rows rows, std::size_t c) {
    return falls_less_than(suspicious, path, rows, c) ||
           (mass(path, rows, c, 0) > 0 && mass(path, rows, c, 0) >= constant * mass(path, rows, c, 1));
}

bool LadderMasses::is_negligible(const LadderPath& path, Rows rows, std::size_t c) const {
    const std::size_t last = last_shell(rows, c);
    return is_negligible(path, rows, c, last - 1) && is_negligible(path, rows, c, last);
}

bool LadderMasses::is_negligible(const LadderPath& path, Rows rows, std::size_t c, std::size_t shell) const {
    const double mass = std::abs(rows[shell][c]) * path.volume(path.exponent(shell), paths_.widths(path));
    return finest_at_origin * mass < std::numeric_limits<double>::epsilon() * most_[c];
}

bool LadderMasses::diverge_further(const LadderPath& path, std::size_t c) {
    if (path.codimension() == 1) return diverge_along(path, c);
    // Other directions, since a diagonal may be a ridge.
    for (int i = 0; i < 2; ++i) {
        LadderPath other = path;
        paths_.vary(other);
        if (!diverge_along(other, c)) return ridge_diverges_along(path, c);
    }
    return diverge_along(path, c);
}

bool LadderMasses::ridge_diverges_along(const LadderPath& path, std::size_t c) {
    constexpr double far_out = 20; // exponent
    return goes_to_infinity(path, raw_.evaluator().domain()) && diverge_along(path, c) &&
           ridge_diverges(raw_, path.at(far_out),
                          [c](const std::vector<double>& row) { return std::abs(row[c]); });
}

bool LadderMasses::diverge_along(LadderPath path, std::size_t c) {
    if (goes_to_infinity(path, raw_.evaluator().domain())) return diverge_at_infinity(path, c);
    // Shells around a place inside, none of which holds an end, in the direction of the path.
    double part = 1;
    for (std::size_t d = 0; d < path.side.size(); ++d)
        if (const double u = path.anchors[d].u; path.side[d] != 0 && u != 0 && u != 1)
            part = std::min(part, std::min(u, 1 - u) / path.reach[d]);
    for (double& reach : path.reach) reach *= part;
    if (path.finest() < least_resolved) return false;
    return masses_diverge(values_along(path, c), path.finest(), path.codimension(), false, path.end());
}

bool LadderMasses::diverge_at_infinity(const LadderPath& path, std::size_t c) {
    const double finest = finest_at_origin / path.codimension();
    const ShellValues values = values_far_out(path, c);
    // Overflow: infinite from half of the way on.
    const std::array<double, 3> far_out{0.5 * finest, 0.75 * finest, finest};
    const std::vector<double> g = values(far_out);
    if (std::ranges::all_of(g, [](double v) { return std::isinf(v); }))
        return is_largest_before_overflow(values, finest, path.codimension());
    return masses_diverge(values, finest, path.codimension(), true);
}

// Whether the last mass before values overflow is the largest. Intermediate results may overflow where a difference has long been
// rounded to zero, or to noise.
bool LadderMasses::is_largest_before_overflow(const ShellValues& values, double finest, int codimension) {
    const LastValue last = last_value(values, 0, finest);
    if (last.beyond == 0) return false;
    const std::array<double, 4> exponents{0.25 * last.exponent, 0.5 * last.exponent, 0.75 * last.exponent,
                                          last.exponent};
    const std::vector<double> g = values(exponents);
    for (std::size_t i = 0; i < g.size(); ++i)
        if (g[i] * std::exp2(codimension * (last.exponent - exponents[i])) > g.back()) return false;
    return true;
}

// Mass that lies farther out than the shell at `finest`, in units of that shell's; 0 where that has none.
double LadderMasses::mass_farther_out(const LadderPath& path, std::size_t c, double finest) {
    constexpr double step = 2;
    std::vector<double> exponents;
    for (double k = finest; k < finest_at_origin; k += step) exponents.push_back(k);
    const std::vector<double> g = values_far_out(path, c)(exponents);
    double sum = 0.5;
    for (std::size_t i = 1; i < g.size(); ++i)
        if (const double mass = g[i] / g[0] * std::exp2(finest - exponents[i]); !std::isnan(mass))
            sum += mass;
    return g[0] > 0 ? step * std::numbers::ln2 * sum : 0;
}

ShellValues LadderMasses::values_along(const LadderPath& path, std::size_t c) {
    return [this, path, c](std::span<const double> exponents) {
        std::vector<std::vector<double>> points;
        for (double k : exponents) points.push_back(path.at(k));
        std::vector<double> g;
        for (const auto& row : raw_(points)) g.push_back(std::abs(row[c]));
        return g;
    };
}

// Shells at infinity, farther out than points of the unit cube can be: |f| at distances 2^k, times the square of the
// volume that these have, so that masses are those of shells of width 2^-k.
ShellValues LadderMasses::values_far_out(const LadderPath& path, std::size_t c) {
    const std::size_t n = path.side.size();
    PointBuffer u(1, static_cast<int>(n)), x(1, static_cast<int>(n));
    for (std::size_t d = 0; d < n; ++d)
        u(0, static_cast<int>(d)) = path.side[d] == 0 ? path.anchors[d].u : 0.5;
    std::array<double, 1> volume{1};
    raw_.evaluator().domain().map(u, x, volume);
    return [this, path, c, x, n](std::span<const double> exponents) {
        std::vector<std::vector<double>> points;
        for (double k : exponents) {
            points.emplace_back(n);
            for (std::size_t d = 0; d < n; ++d)
                points.back()[d] = path.side[d] == 0 ? x.view()(0, static_cast<int>(d))
                                                     : -path.side[d] * std::exp2(path.rate(d) * k) /
                                                           (off_grid * path.reach[d]);
        }
        const auto rows = raw_.at(points);
        std::vector<double> g;
        for (std::size_t i = 0; i < rows.size(); ++i)
            g.push_back(std::abs(rows[i][c]) * std::exp2(2 * path.codimension() * exponents[i]));
        return g;
    };
}

} // namespace montelux
