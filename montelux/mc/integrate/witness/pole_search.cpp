#include "montelux/mc/integrate/witness/pole_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "montelux/mc/integrate/witness/shells.h"

namespace montelux {
namespace {

using Point = std::vector<double>;

constexpr double first_step = 0x1p-5; // of the search for a pole
constexpr double shift = 0.0123;      // of the lines beside it, of the cube's width
constexpr double end = 0x1p-40;
constexpr int most_steps = 120; // of that search
constexpr double coarse = 12;   // least exponent for an extrapolation
constexpr int most_variables = 8;

class PoleSearch {
  public:
    PoleSearch(RawValues& raw, std::size_t component) : raw_(raw), component_(component) {}

    // To the greatest value along a variable: steps to either side, halved where neither is higher.
    void follow(Point& u, std::size_t d) {
        double top = values({u})[0], step = std::min(first_step, 0.5 * std::min(u[d], 1 - u[d]));
        // Products of all coordinates stay within the range of doubles.
        const double least = std::exp2(-finest_at_origin / static_cast<double>(u.size()));
        for (int i = 0; i < most_steps && step > 0.25 * std::numeric_limits<double>::epsilon() * u[d]; ++i) {
            if (!std::isfinite(top)) return;
            Point up = u, down = u;
            up[d] = std::min(u[d] + step, 1 - 0x1p-53);
            down[d] = std::max(u[d] - step, least);
            const std::vector<double> g = values({up, down});
            const std::size_t better = g[1] > g[0] || std::isnan(g[0]) ? 1 : 0;
            if (g[better] > top) {
                top = g[better];
                u = better == 0 ? up : down;
                step = std::min(2 * step, first_step);
            } else {
                step *= 0.5;
            }
        }
    }

    // Do the masses of shells along a variable not fall, on one side at least?
    bool line_diverges(const Point& u, std::size_t d) {
        // The first look has been closer to the ends.
        if (std::min(u[d], 1 - u[d]) < end) return false;
        return masses_diverge(along(u, d, 1), finest_of_side(u, d, 1), 1) ||
               masses_diverge(along(u, d, -1), finest_of_side(u, d, -1), 1);
    }

    bool ball_diverges(const Point& u) {
        const int n = static_cast<int>(u.size());
        double finest = finest_inside;
        for (std::size_t d = 0; d < u.size(); ++d)
            finest = std::min({finest, finest_of_side(u, d, 1), finest_of_side(u, d, -1)});
        // A direction of its own in each variable.
        return masses_diverge(
                   [&](std::span<const double> exponents) { return values(rays(u, exponents, 1)); }, finest,
                   n) &&
               masses_diverge(
                   [&](std::span<const double> exponents) { return values(rays(u, exponents, -1)); }, finest,
                   n);
    }

    // The part of the integral along a line that lies within the finest distance, if the masses follow a power.
    double unresolved(const Point& u, std::size_t d) {
        double sum = 0;
        for (double side : {1.0, -1.0}) {
            const double finest = finest_of_side(u, d, side);
            if (finest < coarse || finest > finest_inside) continue;
            const std::array<double, 2> exponents{finest / 2, finest};
            const std::vector<double> g = along(u, d, side)(exponents);
            const double outer = g[0] * std::exp2(-exponents[0]), inner = g[1] * std::exp2(-exponents[1]);
            if (!(inner > 0 && inner < outer && std::isfinite(outer))) continue;
            const double fall = std::log2(outer / inner) / (exponents[1] - exponents[0]); // 1 - power
            if (fall < 0.9) sum += inner * reach(u[d], side) / fall;
        }
        return sum;
    }

    // Shells around a point, along one ray.
    SlowShells shells_around(const Point& u) {
        constexpr std::array exponents{3.0, 8.0, 15.0, 24.0, 36.0, finest_inside};
        SlowShells slow{u, {}, {exponents.begin(), exponents.end()}};
        const std::vector<Point> points = rays(u, exponents, 1);
        const auto rows = raw_(points);
        double width = 1;
        for (double c : u) width *= 2 * std::min(c, 1 - c);
        const double n = static_cast<double>(u.size());
        for (std::size_t i = 0; i < points.size(); ++i)
            slow.shells.push_back({points[i], rows[i], width * std::exp2(-n * exponents[i])});
        if (!slow.is_slow(component_)) return {};
        return slow;
    }

  private:
    // Exponent of the smallest distance to a side, as a part of what lies there, that doubles resolve.
    double finest_of_side(const Point& u, std::size_t d, double side) const {
        return finest_exponent(raw_.evaluator().domain(), d, u[d]) + std::log2(reach(u[d], side));
    }

    std::vector<double> values(const std::vector<Point>& points) {
        std::vector<double> g;
        for (const auto& row : raw_(points)) g.push_back(std::abs(row[component_]));
        return g;
    }
    ShellValues along(const Point& u, std::size_t d, double side) {
        return [this, u, d, side](std::span<const double> exponents) {
            std::vector<Point> points;
            for (double k : exponents) {
                points.push_back(u);
                points.back()[d] += side * reach(u[d], side) * std::exp2(-k);
            }
            return values(points);
        };
    }
    static std::vector<Point> rays(const Point& u, std::span<const double> exponents, double side) {
        std::vector<Point> points;
        for (double k : exponents) {
            points.push_back(u);
            for (std::size_t d = 0; d < u.size(); ++d) {
                const double own =
                    (d % 2 == 0 ? side : -side) *
                    (0.5 + 0.5 * std::fmod(0.6180339887498949 * static_cast<double>(d + 1), 1.0));
                points.back()[d] += own * std::min(u[d], 1 - u[d]) * std::exp2(-k);
            }
        }
        return points;
    }

    RawValues& raw_;
    std::size_t component_;
};

} // namespace

PoleReport search_pole(RawValues& raw, const Witness& from, std::size_t component) {
    PoleSearch search(raw, component);
    PoleReport report;
    report.u = from.u;
    const std::size_t n = from.u.size();
    if (n > most_variables) return report;
    for (std::size_t d = 0; d < n; ++d) search.follow(report.u, d);
    if (n == 1) {
        report.diverges = search.line_diverges(report.u, 0);
        if (!report.diverges && std::min(report.u[0], 1 - report.u[0]) > end)
            report.unresolved = search.unresolved(report.u, 0);
        return report;
    }
    const bool at_end = std::ranges::any_of(report.u, [](double u) { return std::min(u, 1 - u) < end; });
    if (!at_end && search.ball_diverges(report.u)) {
        report.diverges = true;
        return report;
    }
    for (std::size_t d = 0; d < n && !report.diverges; ++d) {
        if (!search.line_diverges(report.u, d)) continue;
        // A pole of a surface meets a line beside this one; one of a point or a curve does not.
        Point beside = report.u;
        for (std::size_t e = 0; e < n; ++e)
            // By an amount of its own in each variable, or a diagonal curve would go along.
            if (e != d)
                beside[e] += (beside[e] < 0.5 ? shift : -shift) *
                             (0.5 + std::fmod(0.6180339887498949 * static_cast<double>(e + 1), 1.0));
        search.follow(beside, d);
        report.diverges = search.line_diverges(beside, d);
    }
    if (!report.diverges && !at_end) report.slow = search.shells_around(report.u);
    return report;
}

} // namespace montelux
