#include "montelux/mc/integrate/witness/ridge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "montelux/mc/integrate/witness/shells.h"

namespace montelux {
namespace {

constexpr double far_out = 1e-4; // of the cube's width, from an end at infinity
// Exponents of the distances from that end; closer to 1 doubles do not resolve widths of one unit.
constexpr std::array scales{22.0, 18.0, 14.0, 10.0};
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
    PointBuffer at(1, raw.evaluator().dimensions()), x(1, domain.dimensions());
    for (std::size_t d = 0; d < u.size(); ++d) at(0, static_cast<int>(d)) = u[d];
    std::array<double, 1> volume{1};
    domain.map(at, x, volume);
    std::vector<std::vector<double>> points;
    for (double k : far_exponents) {
        points.emplace_back(u.size());
        for (std::size_t d = 0; d < u.size(); ++d) points.back()[d] = x.view()(0, static_cast<int>(d));
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

} // namespace montelux
