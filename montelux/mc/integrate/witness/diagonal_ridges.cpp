#include "montelux/mc/integrate/witness/diagonal_ridges.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace montelux {
namespace {

using Point = std::vector<double>;

constexpr double far_heavier = 16; // than in other directions, or than beside a ridge
constexpr int most_bisections = 6; // of exponents up to 52

struct Diagonal {
    std::size_t ladder, shell; // the heaviest one
    double height, mass;
    Point top, beside; // a point of the diagonal, and one in another direction
    double inside = 52,
           outside = 0; // exponents of the part of the way between them where the ridge is half as high
};

// Point whose distances from a place differ from the diagonal's.
Point point_beside(const Point& on_diagonal, const LadderPath& path) {
    Point u = on_diagonal;
    for (std::size_t d = 0; d < u.size(); ++d)
        u[d] +=
            0.5 * (path.anchors[d].u - u[d]) * static_cast<double>(d + 1) / static_cast<double>(u.size() + 1);
    return u;
}

} // namespace

void measure_diagonals(RawValues& raw, std::span<LadderPath> paths, std::span<const Point> points,
                       std::span<const std::vector<double>> rows, std::span<const double> volumes,
                       std::uint64_t most_evaluations) {
    std::vector<double> unit(static_cast<std::size_t>(raw.evaluator().components()), 0.0);
    for (const auto& row : rows)
        for (std::size_t c = 0; c < row.size(); ++c)
            if (std::isfinite(row[c])) unit[c] = std::max(unit[c], std::abs(row[c]));
    const auto size = [&](const std::vector<double>& row) {
        double sum = 0;
        for (std::size_t c = 0; c < row.size(); ++c)
            if (unit[c] > 0) sum += std::abs(row[c]) / unit[c];
        return std::isfinite(sum) ? sum : 0;
    };

    std::vector<Diagonal> diagonals;
    double others = 0; // largest mass of ladders in other directions
    for (std::size_t p = 0; p < points.size() / ladder.size(); ++p) {
        if (paths[p].codimension() < 2) continue;
        const std::size_t first = p * ladder.size();
        std::size_t heaviest = first;
        const auto mass = [&](std::size_t i) { return size(rows[i]) * volumes[i]; };
        for (std::size_t i = first; i < first + ladder.size(); ++i)
            if (mass(i) > mass(heaviest)) heaviest = i;
        if (paths[p].is_diagonal)
            diagonals.push_back({p, heaviest - first, size(rows[heaviest]), mass(heaviest), points[heaviest],
                                 point_beside(points[heaviest], paths[p])});
        else
            others = std::max(others, mass(heaviest));
    }
    std::erase_if(diagonals,
                  [&](const Diagonal& d) { return !(others > 0 && d.mass > far_heavier * others); });
    if ((most_bisections + 1) * diagonals.size() > most_evaluations) return;

    for (int round = 0; round <= most_bisections; ++round) {
        const auto exponent = [&](const Diagonal& d) {
            return round == 0 ? 0 : 0.5 * (d.inside + d.outside);
        };
        std::vector<Point> between;
        for (const Diagonal& d : diagonals) {
            const double part = std::exp2(-exponent(d));
            between.push_back(d.top);
            for (std::size_t i = 0; i < d.top.size(); ++i)
                between.back()[i] += part * (d.beside[i] - d.top[i]);
        }
        const auto seen = raw(between);
        std::vector<Diagonal> on_ridges;
        for (std::size_t i = 0; i < diagonals.size(); ++i) {
            Diagonal& d = diagonals[i];
            if (round > 0) (size(seen[i]) >= 0.5 * d.height ? d.inside : d.outside) = exponent(d);
            if (round > 0 || far_heavier * size(seen[i]) < d.height) on_ridges.push_back(std::move(d));
        }
        diagonals = std::move(on_ridges);
    }
    for (const Diagonal& d : diagonals)
        paths[d.ladder].thickness = std::exp2(-d.inside - paths[d.ladder].exponent(d.shell));
}

} // namespace montelux
