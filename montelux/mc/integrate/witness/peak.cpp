#include "montelux/mc/integrate/witness/peak.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "montelux/mc/integrate/witness/shells.h"

namespace montelux {
namespace {

constexpr double enough_points = 8; // all of them miss a peak with a probability of 3e-4
constexpr double ordinary = 16;     // weights up to so many times their mean are explained by the density
constexpr double part = 0.5; // of value x volume, below the integral of any peak that falls monotonically

} // namespace

Witness climb(RawValues& raw, Witness top, const Magnitude& magnitude) {
    for (std::size_t d = 0; d < top.u.size(); ++d) {
        std::vector<std::vector<double>> points;
        for (double side : {1.0, -1.0})
            for (double k = 2; k <= 50; k += 4) {
                points.push_back(top.u);
                points.back()[d] += side * reach(top.u[d], side) * off_grid * std::exp2(-k);
            }
        const auto rows = raw(points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (!std::ranges::all_of(rows[i], [](double v) { return std::isfinite(v); })) continue;
            if (magnitude(rows[i]) > magnitude(top.value)) top = {points[i], rows[i]};
        }
    }
    return top;
}

void measure(RawValues& raw, Witness& top, const Magnitude& magnitude, int finer) {
    const std::size_t n = top.u.size();
    const double half = 0.5 * magnitude(top.value);
    // Exponents of distances: down to the spacing of doubles, which is finer towards the origin of the cube.
    std::vector<double> inside(2 * n), outside(2 * n, 0.0);
    double widest = 0;
    for (std::size_t i = 0; i < 2 * n; ++i) {
        const double u = top.u[i / 2];
        inside[i] = 52 - (i % 2 == 0 ? std::log2(std::min(u, 0.5)) : 0);
        widest = std::max(widest, inside[i]);
    }
    const int bisections = static_cast<int>(std::ceil(std::log2(widest))) + finer;
    for (int round = 0; round < bisections; ++round) {
        std::vector<std::vector<double>> points;
        for (std::size_t i = 0; i < 2 * n; ++i) {
            const double side = i % 2 == 0 ? 1 : -1;
            points.push_back(top.u);
            points.back()[i / 2] +=
                side * reach(top.u[i / 2], side) * std::exp2(-0.5 * (inside[i] + outside[i]));
        }
        const auto rows = raw(points);
        for (std::size_t i = 0; i < 2 * n; ++i)
            (magnitude(rows[i]) >= half ? inside[i] : outside[i]) = 0.5 * (inside[i] + outside[i]);
    }
    top.volume = 1;
    top.extent.resize(n);
    for (std::size_t d = 0; d < n; ++d) {
        top.extent[d] = 0.5 * (reach(top.u[d], 1) * std::exp2(-inside[2 * d]) +
                               reach(top.u[d], -1) * std::exp2(-inside[2 * d + 1]));
        top.volume *= 2 * top.extent[d];
    }
}

bool is_rounding(const Witness& top) {
    for (std::size_t d = 0; d < top.u.size(); ++d)
        if (top.extent[d] < 0x1p-48 * top.u[d]) return true;
    return false;
}

bool belongs(RawValues& raw, const Witness& w, const Witness& top, const Magnitude& magnitude) {
    std::vector<std::vector<double>> between;
    for (double t : {0.25, 0.5, 0.75}) {
        between.push_back(w.u);
        for (std::size_t d = 0; d < w.u.size(); ++d) between.back()[d] += t * (top.u[d] - w.u[d]);
    }
    const double least = 0.5 * std::min(magnitude(w.value), magnitude(top.value));
    return std::ranges::all_of(raw(between), [&](const auto& row) { return magnitude(row) >= least; });
}

std::vector<Witness> opposite_peaks(RawValues& raw, const Witness& peak, const Magnitude& magnitude) {
    constexpr double near = 8; // extents
    std::vector<Witness> found;
    for (std::size_t d = 0; d < peak.u.size(); ++d) {
        if (!(std::min(peak.u[d], 1 - peak.u[d]) < near * peak.extent[d])) continue;
        Witness opposite{peak.u, {}};
        opposite.u[d] = std::min(1 - peak.u[d], 1 - 0x1p-53);
        opposite.value = raw({opposite.u})[0];
        if (!(magnitude(opposite.value) > 0.5 * magnitude(peak.value))) continue;
        measure(raw, opposite, magnitude);
        if (!is_rounding(opposite)) found.push_back(std::move(opposite));
    }
    return found;
}

double unexplained(double value, double volume, double q, double points, double size) {
    const double mass = part * std::abs(value) * volume;
    if (!(std::abs(value) > ordinary * q * size) || !(points * q * volume < enough_points)) return 0;
    return mass;
}

} // namespace montelux
