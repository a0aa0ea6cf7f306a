#include "montelux/mc/integrate/witness/ridge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "montelux/mc/integrate/witness/guide_zeros.h"
#include "montelux/mc/integrate/witness/shells.h"

namespace montelux {
namespace {

constexpr double far_out = 1e-4; // of the cube's width, from an end at infinity
// Exponents of the distances from that end; closer to 1 doubles do not resolve widths of one unit.
constexpr std::array scales{22.0, 18.0, 14.0, 10.0};
// Ridges of a guide: exponents of the distances between scales, the last one, and the least part of the mass two scales
// before.
constexpr double guided_step = 3, most_guided_scale = 45, guided_fall = 0.85;
constexpr double valley =
    100; // times the value on a line: where it is greater beside it, the line is no ridge
constexpr double not_falling = 0.8;              // of the outermost mass beside the innermost one,
constexpr double steady = 0.4;                   // and of any other beside the next
constexpr std::array far_exponents{16.0, 200.0}; // of distances
constexpr int finer = 4;                         // further bisections of a width
constexpr int climbs = 2;
constexpr double same_shell = 4; // ratio of distances

// The side towards an end at infinity; 0 where that is not near.
double side_of(const Domain& domain, std::span<const double> u, std::size_t d) {
    const std::span<const Range> ranges = domain.ranges();
    if (ranges.empty()) return 0;
    if (std::isinf(ranges[d].lower) && u[d] < far_out) return -1;
    return std::isinf(ranges[d].upper) && 1 - u[d] < far_out ? 1 : 0;
}

std::vector<double> point_of_box(const Domain& domain, const std::vector<double>& u) {
    PointBuffer at(1, static_cast<int>(u.size())), x(1, domain.dimensions());
    for (std::size_t d = 0; d < u.size(); ++d) at(0, static_cast<int>(d)) = u[d];
    std::array<double, 1> volume{1};
    domain.map(at, x, volume);
    std::vector<double> point(u.size());
    x.view().gather(0, point.data());
    return point;
}

// Whether |f| falls faster than 1 / distance along the only variable that is far out, at distances that points of the cube
// do not reach.
bool falls_along(RawValues& raw, const std::vector<double>& u, const Magnitude& magnitude) {
    const Domain& domain = raw.evaluator().domain();
    std::size_t along = u.size();
    for (std::size_t d = 0; d < u.size(); ++d)
        if (side_of(domain, u, d) != 0) {
            if (along < u.size()) return false;
            along = d;
        }
    std::vector<std::vector<double>> points;
    for (double k : far_exponents) {
        points.push_back(point_of_box(domain, u));
        points.back()[along] = side_of(domain, u, along) * std::exp2(k);
    }
    const auto rows = raw.at(points);
    const double first = magnitude(rows.front()) * std::exp2(far_exponents.front()),
                 last = magnitude(rows.back()) * std::exp2(far_exponents.back());
    return std::isfinite(first) && last < not_falling * first;
}

} // namespace

bool is_far_out(const Domain& domain, std::span<const double> u) {
    for (std::size_t d = 0; d < u.size(); ++d)
        if (side_of(domain, u, d) != 0) return true;
    return false;
}

bool ridge_diverges(RawValues& raw, const std::vector<double>& u, const Magnitude& magnitude) {
    const Domain& domain = raw.evaluator().domain();
    double nearest = 1;
    for (std::size_t d = 0; d < u.size(); ++d)
        if (const double side = side_of(domain, u, d); side != 0)
            nearest = std::min(nearest, reach(u[d], side));
    if (nearest == 1 || u.size() == 1) return false;

    if (falls_along(raw, u, magnitude)) return false;
    std::array<double, scales.size()> mass{};
    for (std::size_t i = 0; i < scales.size(); ++i) {
        Witness top{u, {}};
        for (std::size_t d = 0; d < u.size(); ++d) {
            const double side = side_of(domain, u, d);
            if (side == 0) continue;
            const double distance = reach(u[d], side) / nearest * std::exp2(-scales[i]);
            if (distance > 0.25) return false;
            top.u[d] = side > 0 ? 1 - distance : distance;
        }
        top.value = raw({top.u})[0];
        for (int k = 0; k < climbs; ++k) top = climb(raw, std::move(top), magnitude);
        // A climb back out of the shell is one along the flank of a wide peak.
        for (std::size_t d = 0; d < u.size(); ++d)
            if (const double side = side_of(domain, u, d);
                side != 0 &&
                reach(top.u[d], side) > same_shell * reach(u[d], side) / nearest * std::exp2(-scales[i]))
                return false;
        if (!(magnitude(top.value) > 0) || !std::isfinite(magnitude(top.value))) return false;
        measure(raw, top, magnitude, finer);
        if (is_rounding(top)) return false;
        // Along one of the variables the ridge goes through all of the shell, and not only within its width.
        double length = 1;
        for (std::size_t d = 0; d < u.size(); ++d)
            if (const double side = side_of(domain, u, d); side != 0)
                length = std::max(length, reach(top.u[d], side) / top.extent[d]);
        mass[i] = magnitude(top.value) * top.volume * length;
        if (i > 0 && !(mass[i - 1] >= steady * mass[i])) return false;
    }
    return mass.front() >= not_falling * mass.back();
}

namespace {

// The line or plane at x_d in a box, its other variables by sinh, so that all distances up to 2^64 are resolved alike.
class FarSlice {
  public:
    FarSlice(std::size_t n, std::size_t d, double x_d) : n_(n), d_(d), x_d_(x_d) {}

    Domain domain() const {
        return Domain::mapped(static_cast<int>(n_) - 1, static_cast<int>(n_),
                              [slice = *this](std::span<const double> v, std::span<double> x) {
                                  std::ranges::copy(slice.point(v), x.begin());
                                  return 1.0;
                              });
    }
    std::vector<double> point(std::span<const double> v) const {
        std::vector<double> x(n_, x_d_);
        for (std::size_t e = 0, k = 0; e < n_; ++e)
            if (e != d_) x[e] = std::sinh(range * (2 * v[k++] - 1));
        return x;
    }
    std::vector<double> place(const std::vector<double>& x) const {
        std::vector<double> v;
        for (std::size_t e = 0; e < n_; ++e)
            if (e != d_) v.push_back(0.5 + 0.5 * std::asinh(x[e]) / range);
        return v;
    }

  private:
    static constexpr double range = 45;
    std::size_t n_, d_;
    double x_d_;
};

// Half widths of a ridge at x across variable d: by bisection of the exponents of distances; the product of twice
// these, 0 where doubles do not resolve one, and -1 where x is in a valley.
double width_across(RawValues& raw, const std::vector<double>& x, std::size_t d, double height,
                    const Magnitude& magnitude) {
    constexpr double finest = 32, coarsest = -4; // climbs are exact to 2^-36
    constexpr int bisections = 10;
    double product = 1;
    for (std::size_t e = 0; e < x.size(); ++e) {
        if (e == d) continue;
        const Range& range = raw.evaluator().domain().ranges()[e];
        const double scale = std::max(1.0, std::abs(x[e]));
        double width = 0;
        for (double side : {-1.0, 1.0}) {
            double inside = finest, outside = coarsest;
            for (int i = 0; i < bisections; ++i) {
                const double middle = 0.5 * (inside + outside);
                std::vector<double> at = x;
                at[e] += side * scale * std::exp2(-middle);
                const bool in_range = at[e] > range.lower && at[e] < range.upper;
                const double here = in_range ? magnitude(raw.at({at})[0]) : 0;
                if (here > valley * height) return -1;
                (here >= 0.5 * height ? inside : outside) = middle;
            }
            if (inside == finest) return 0;
            width += scale * std::exp2(-inside);
        }
        product *= width;
    }
    return product;
}

// Whether the masses of a ridge do not fall from scale to scale of variable d, as far out as doubles resolve it.
bool diverges_far_out(RawValues& raw, const Integrand::BatchFunction& guide, std::vector<double> x,
                      std::size_t d, double side, const Magnitude& magnitude) {
    const std::span<const Range> ranges = raw.evaluator().domain().ranges();
    const double other_end = side > 0 ? ranges[d].lower : ranges[d].upper;
    std::vector<double> masses;
    for (double k = guided_step; k <= most_guided_scale; k += guided_step) {
        const FarSlice slice(x.size(), d, (std::isinf(other_end) ? 0 : other_end) + side * std::exp2(k));
        x = slice.point(climb_to_zero(guide, slice.domain(), slice.place(x)));
        for (std::size_t e = 0; e < x.size(); ++e)
            if (!(x[e] > ranges[e].lower && x[e] < ranges[e].upper)) return false;
        const double height = magnitude(raw.at({x})[0]);
        if (!(height > 0) || !std::isfinite(height)) return false;
        const double width = width_across(raw, x, d, height, magnitude);
        if (width < 0) return false;
        if (width == 0) break;
        masses.push_back(height * width * std::exp2(k));
        const std::size_t i = masses.size();
        if (i > 2 && masses[i - 1] < guided_fall * masses[i - 3]) return false;
    }
    return masses.size() > 2;
}

} // namespace

bool is_valley(RawValues& raw, const Witness& top, const Magnitude& magnitude) {
    std::vector<std::vector<double>> beside;
    for (std::size_t d = 0; d < top.u.size(); ++d)
        for (double side : {-0.5, 0.5}) {
            beside.push_back(top.u);
            beside.back()[d] += side * top.extent[d];
        }
    const double high = valley * magnitude(top.value);
    return std::ranges::any_of(raw(beside), [&](const auto& row) { return magnitude(row) > high; });
}

RidgeToEnd follow_ridge(RawValues& raw, const Integrand::BatchFunction& guide,
                        const std::vector<double>& from, std::size_t d, double side,
                        const Magnitude& magnitude, double least, std::uint64_t most_evaluations) {
    const Domain& domain = raw.evaluator().domain();
    const std::uint64_t begin = raw.evaluations();
    RidgeToEnd ridge;
    bool rounded = false;
    const auto climbed = [&](double k) {
        Witness w{ridge.tops.empty() ? from : ridge.tops.back().u, {}};
        w.u[d] = side > 0 ? 1 - std::exp2(-k) : std::exp2(-k);
        w.u = climb_to_zero(guide, domain, std::move(w.u), d);
        w.value = raw({w.u})[0];
        return w;
    };
    const auto measured = [&](double k) -> std::optional<Witness> {
        Witness top = climbed(k);
        const double height = magnitude(top.value);
        if (!(height > 0) || !std::isfinite(height)) return {};
        measure(raw, top, magnitude, finer);
        const bool rounds = is_rounding(top);
        rounded = rounded || rounds;
        if (rounds || is_valley(raw, top, magnitude)) return {};
        top.volume *= std::exp2(-k) / (2 * top.extent[d]); // all of the shell
        if (!(height * top.volume > least)) return {};
        return top;
    };
    std::vector<double> masses;
    double scale = guided_step;
    for (; scale <= most_guided_scale && raw.evaluations() - begin <= most_evaluations;
         scale += guided_step) {
        const std::optional<Witness> top = measured(scale);
        if (!top) break;
        // Octaves between two scales, whose volumes fall by a power.
        const double before = masses.empty() ? 0 : ridge.tops.back().volume;
        for (double octave = 1; !masses.empty() && octave < guided_step; ++octave) {
            Witness w = climbed(scale - guided_step + octave);
            w.volume = before * std::pow(top->volume / before, octave / guided_step);
            ridge.tops.push_back(std::move(w));
        }
        masses.push_back(magnitude(top->value) * top->volume);
        ridge.tops.push_back(*top);
    }
    for (double octave = 1; !masses.empty() && most_evaluations > 0 && octave < guided_step; ++octave) {
        const std::optional<Witness> top = measured(scale - guided_step + octave);
        if (!top) break;
        ridge.tops.push_back(*top);
    }
    if (rounded && masses.size() > 1) {
        const double fall = std::pow(masses.back() / masses[masses.size() - 2], 1 / guided_step);
        ridge.beyond = fall < 1 ? fall / (1 - fall) : 0;
    }
    const std::span<const Range> ranges = domain.ranges();
    if (ranges.empty() || !std::isinf(side > 0 ? ranges[d].upper : ranges[d].lower)) return ridge;
    if (masses.size() < 3 || !(masses[2] >= steady * masses[0])) return ridge;
    ridge.diverges =
        diverges_far_out(raw, guide, point_of_box(domain, ridge.tops.front().u), d, side, magnitude);
    return ridge;
}

} // namespace montelux
