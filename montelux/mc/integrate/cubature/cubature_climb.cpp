#include "montelux/mc/integrate/cubature/cubature_climb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "montelux/mc/integrate/adaptive/mode_search.h"

namespace montelux {
namespace {

constexpr std::size_t most_climbs = 8; // from surprises, and from hints
constexpr std::size_t most_hints = 64; // that are considered

} // namespace

void CubatureClimb::from_surprises() {
    std::vector<std::pair<double, std::size_t>> order; // greatest surprise, relative to the tolerance
    for (std::size_t i = 0; i < check_.surprises.size(); ++i) {
        double size = 0;
        for (std::size_t c = 0; c < tolerance_.size(); ++c)
            if (tolerance_[c] > 0)
                size = std::max(size, surprise(regions_, check_.surprises[i].region, c,
                                               check_.surprises[i].value[c], tolerance_[c]) /
                                          tolerance_[c]);
        order.emplace_back(-size, i);
    }
    std::ranges::sort(order);
    for (std::size_t k = 0; k < std::min(order.size(), most_climbs); ++k)
        climb(CubatureWitness(check_.surprises[order[k].second]));
}

void CubatureClimb::from_hints() {
    std::ranges::sort(check_.hints, std::greater{},
                      [&](const CubatureWitness& w) { return size(w.value, {}); });
    std::vector<CubatureWitness> tops;
    for (std::size_t k = 0; k < std::min(check_.hints.size(), most_hints) && tops.size() < most_climbs; ++k) {
        const CubatureWitness& hint = check_.hints[k];
        if (std::ranges::any_of(tops, [&](const CubatureWitness& top) { return is_on_flank(hint, top); }))
            continue;
        if (!climb(hint)) continue;
        tops.push_back(check_.surprises.back());
    }
}

double CubatureClimb::size(std::span<const double> value, std::span<const double> means) const {
    double sum = 0;
    for (std::size_t c = 0; c < value.size(); ++c)
        if (tolerance_[c] > 0) sum += std::abs(value[c] - (means.empty() ? 0 : means[c])) / tolerance_[c];
    return sum;
}

std::vector<double> CubatureClimb::sizes_at(const PointBatch& x, std::span<const double> means) {
    const int m = evaluator_.components();
    ValueBuffer g(x.count(), m);
    evaluator_(x, g, check_.non_finite);
    evaluations_ += x.count();
    std::vector<double> sizes, value(static_cast<std::size_t>(m));
    for (std::size_t i = 0; i < x.count(); ++i) {
        for (int c = 0; c < m; ++c) value[static_cast<std::size_t>(c)] = std::as_const(g)(i, c);
        sizes.push_back(size(value, means));
    }
    return sizes;
}

bool CubatureClimb::is_on_flank(const CubatureWitness& w, const CubatureWitness& top) {
    constexpr std::array parts{0.25, 0.5, 0.75};
    PointBuffer between(parts.size(), evaluator_.dimensions());
    for (std::size_t i = 0; i < parts.size(); ++i)
        for (std::size_t d = 0; d < w.x.size(); ++d)
            between(i, static_cast<int>(d)) = w.x[d] + parts[i] * (top.x[d] - w.x[d]);
    const double here = size(w.value, {});
    return std::ranges::all_of(sizes_at(between, {}), [&](double v) { return v >= here; });
}

bool CubatureClimb::climb(const CubatureWitness& from) {
    const auto n = static_cast<std::uint64_t>(evaluator_.dimensions());
    const std::uint64_t of_each = 80 * n + 4 * n * n;
    if (evaluations_ + of_each + 1 > most_) return false;
    std::vector<double> means;
    for (double value : regions_.value(from.region)) means.push_back(value / regions_.volume(from.region));
    const DensityFunction h = [&](const PointBatch& x, std::span<double> values) {
        std::ranges::copy(sizes_at(x, means), values.begin());
    };
    PointBuffer start(1, evaluator_.dimensions());
    for (std::size_t d = 0; d < from.x.size(); ++d) start(0, static_cast<int>(d)) = from.x[d];
    const std::array<double, 1> at_start{size(from.value, means)};
    ModeSearch settings;
    settings.most_modes = 1;
    settings.fruitless = 1;
    settings.max_evaluations = of_each;
    const std::vector<Gaussian> modes = find_modes(h, start, at_start, settings);
    if (modes.empty()) return false;
    CubatureWitness top{
        regions_.containing(modes[0].mean()), {modes[0].mean().begin(), modes[0].mean().end()}, {}};
    for (std::size_t d = 0; d < top.x.size(); ++d) start(0, static_cast<int>(d)) = top.x[d];
    ValueBuffer g(1, evaluator_.components());
    evaluator_(start, g, check_.non_finite);
    ++evaluations_;
    for (int c = 0; c < evaluator_.components(); ++c) top.value.push_back(std::as_const(g)(0, c));
    check_.surprises.push_back(std::move(top));
    return true;
}

} // namespace montelux
