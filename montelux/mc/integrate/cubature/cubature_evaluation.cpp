#include "montelux/mc/integrate/cubature/cubature_evaluation.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "montelux/mc/parallel/parallel_for.h"

namespace montelux {
namespace {

// Minimum points per evaluator call, if there are regions enough.
constexpr std::size_t points_per_task = 512;

// Value, error and marks of a region from the integrand's values. `not_finite`: some were not, and are zero.
void assess(CubatureRegions& fresh, std::size_t r, const SymmetricRule& rule,
            const std::vector<std::span<const double>>& values, bool not_finite,
            std::span<const double> totals) {
    const std::size_t n = fresh.centre(r).size();
    std::vector<double> nulls(static_cast<std::size_t>(rule.null_rules()));
    std::vector<double> differences(n, 0.0);
    const double volume = fresh.volume(r);
    std::ranges::fill(fresh.face_error(r), 0.0);
    CubatureRegions::Marks& marks = fresh.marks(r);
    marks = {};
    marks.exhausted = true;
    double worst = -1, ratio = 0;
    for (std::size_t c = 0; c < values.size(); ++c) {
        const double mean = rule.apply(values[c], nulls);
        double size = 0, largest = 0;
        for (double v : values[c]) {
            size += std::abs(v);
            largest = std::max(largest, std::abs(v));
        }
        size /= static_cast<double>(values[c].size());
        const double rounding = 8 * std::numeric_limits<double>::epsilon() * size;
        const SymmetricRule::Assessment found = rule.assess(nulls, rounding);
        // Without its middle the odd 1/x would integrate to zero: zeros beside other values may be poles.
        const double pole = not_finite ? largest : 0;
        const double error = std::max(
            {found.error + rule.edge_surprise(values[c]), rule.odd_surprise(values[c], rounding), pole});
        marks.exhausted = marks.exhausted && error <= rounding;
        fresh.value(r)[c] = volume * mean;
        fresh.error(r)[c] = volume * std::max(error, rounding);
        const auto [low, high] = std::ranges::minmax(values[c]);
        fresh.lowest(r)[c] = low;
        fresh.highest(r)[c] = high;
        // The component of the largest relative error decides how to divide.
        const double weight = totals[c] != 0 ? 1 / std::abs(totals[c]) : size > 0 ? 1 / (volume * size) : 0;
        if (n > 1) rule.add_roughness(values[c], weight, differences);
        if (error * weight > worst) {
            worst = error * weight;
            ratio = found.ratio;
        }
    }
    // Degree 13 in two dimensions pays only where the integrand is very smooth.
    const double smooth = n <= 3 ? 0.15 : 1;
    marks.rough = ratio >= smooth;
    std::span<const double> h = fresh.half_width(r);
    std::size_t axis = 0;
    for (std::size_t d = 1; d < differences.size(); ++d) {
        const double here = differences[d], best = differences[axis];
        constexpr double rounding = 1e-10;
        if (here > best * (1 + rounding) || (here >= best * (1 - rounding) && h[d] > h[axis])) axis = d;
    }
    marks.axis = static_cast<std::uint8_t>(axis);
    marks.indivisible = h[axis] < 64 * std::numeric_limits<double>::epsilon() * fresh.centre(r)[axis] ||
                        volume < std::numeric_limits<double>::min() * 1e8;
}

// The points of symmetric rules often coincide with singularities on diagonals and at centres. Where the
// integrand is not finite it is evaluated again at a generic point nearby; `not_finite` keeps those that are
// not finite there either.
void shift_off_singularities(const Evaluator& evaluator, const PointBuffer& u, std::size_t known,
                             const CubatureWork& work, std::size_t begin, ValueBuffer& values,
                             std::vector<std::size_t>& not_finite, NonFiniteCount& non_finite,
                             std::uint64_t& shifted) {
    constexpr double step = 1e-3; // of the half width
    const int n = evaluator.dimensions();
    std::vector<std::size_t> distinct = not_finite; // one entry for each component that is not finite
    std::ranges::sort(distinct);
    distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
    PointBuffer moved(distinct.size(), n);
    std::size_t region = begin, end_of_region = work.rules[begin]->points();
    for (std::size_t i = 0; i < distinct.size(); ++i) {
        while (distinct[i] >= end_of_region) end_of_region += work.rules[++region]->points();
        for (int d = 0; d < n; ++d) {
            const double h = work.fresh.half_width(region)[static_cast<std::size_t>(d)];
            const double x = u.view()(distinct[i] - known, d);
            // Towards the middle of the cube, by a different amount in each coordinate.
            const double by = step * h * (0.5 + std::fmod(0.6180339887498949 * (d + 1), 1.0));
            moved(i, d) = x < 0.5 ? x + by : x - by;
        }
    }
    ValueBuffer again(distinct.size(), evaluator.components());
    std::vector<std::size_t> still;
    evaluator(moved, again, non_finite, &still);
    shifted += distinct.size();
    for (std::size_t i = 0; i < distinct.size(); ++i)
        for (int c = 0; c < evaluator.components(); ++c)
            values.view()(distinct[i], c) = std::as_const(again)(i, c);
    not_finite.clear();
    for (std::size_t i : still) not_finite.push_back(distinct[i]);
    non_finite.count += still.size(); // at the points themselves, too
}

// Regions [begin, end).
void evaluate_some(const Evaluator& evaluator, const CubatureWork& work, std::span<const double> totals,
                   std::size_t begin, std::size_t end, NonFiniteCount& non_finite, std::uint64_t& shifted,
                   std::vector<char>& nonzero) {
    const std::size_t components = nonzero.size();
    const int n = evaluator.dimensions();
    const std::vector<const SymmetricRule*>& rules = work.rules;
    CubatureRegions& fresh = work.fresh;
    const std::size_t known = work.nested != nullptr ? work.nested->count() : 0;
    std::size_t count = 0;
    for (std::size_t r = begin; r < end; ++r) count += rules[r]->points();
    PointBuffer u(count - known, n);
    for (int d = 0; d < n; ++d) {
        double* to = u.coordinate(d).data();
        for (std::size_t r = begin; r < end; ++r) {
            const double c = fresh.centre(r)[static_cast<std::size_t>(d)];
            const double h = fresh.half_width(r)[static_cast<std::size_t>(d)];
            for (double x : rules[r]->offsets().view().coordinate(d).subspan(known)) *to++ = c + h * x;
        }
    }
    ValueBuffer values(count, evaluator.components());
    std::vector<std::size_t> not_finite; // indices of points
    NonFiniteCount first_time;
    evaluator(u, values.view().slice(known, count - known), first_time, &not_finite);
    for (std::size_t& i : not_finite) i += known;
    if (!work.may_shift)
        non_finite.merge(first_time);
    else
        non_finite.vanished += first_time.vanished;
    if (work.may_shift && !not_finite.empty())
        shift_off_singularities(evaluator, u, known, work, begin, values, not_finite, non_finite, shifted);
    if (work.nested_not_finite) not_finite.insert(not_finite.begin(), 0);
    std::ranges::sort(not_finite);
    auto next = not_finite.begin();
    if (work.nested != nullptr) {
        for (int c = 0; c < evaluator.components(); ++c)
            std::ranges::copy(std::as_const(*work.nested).component(c), values.component(c).begin());
        *work.nested = values;
    }
    std::size_t first = 0;
    std::vector<std::span<const double>> of_region(components);
    for (std::size_t r = begin; r < end; ++r) {
        for (std::size_t c = 0; c < components; ++c) {
            of_region[c] =
                std::as_const(values).component(static_cast<int>(c)).subspan(first, rules[r]->points());
            if (nonzero[c] == 0)
                nonzero[c] = std::ranges::any_of(of_region[c], [](double v) { return v != 0; });
        }
        const auto end_of_region = std::lower_bound(next, not_finite.end(), first + rules[r]->points());
        assess(fresh, r, *rules[r], of_region, next != end_of_region, totals);
        next = end_of_region;
        for (std::size_t c = 0; n == 1 && c < components; ++c)
            for (bool upper : {false, true}) {
                const SymmetricRule::FaceValue face = rules[r]->face_value(of_region[c], 0, upper);
                fresh.face(r, c, upper) = {face.value, face.slack, face.unseen};
            }
        if (!work.parents.empty()) {
            const int axis = work.regions.marks(work.parents[r / 2]).axis;
            for (std::size_t c = 0; c < components; ++c)
                work.faces[r * components + c] = rules[r]->face_value(of_region[c], axis, r % 2 == 0);
        }
        first += rules[r]->points();
    }
}

} // namespace

bool evaluate_regions(const Evaluator& evaluator, const CubatureWork& work, std::span<const double> totals,
                      NonFiniteCount& non_finite, std::uint64_t& shifted, std::vector<char>& nonzero,
                      const CancelFlag* cancel) {
    const std::vector<const SymmetricRule*>& rules = work.rules;
    std::vector<std::size_t> starts; // of the tasks
    std::size_t points = points_per_task;
    for (std::size_t r = 0; r < rules.size(); ++r) {
        if (points >= points_per_task) {
            starts.push_back(r);
            points = 0;
        }
        points += rules[r]->points();
    }
    const std::size_t tasks = starts.size();
    starts.push_back(rules.size());
    std::vector<NonFiniteCount> counts(tasks);
    std::vector<std::uint64_t> shifts(tasks, 0);
    std::vector<std::vector<char>> seen(tasks, std::vector<char>(nonzero.size(), 0));
    auto run = [&](std::int64_t task) {
        const auto t = static_cast<std::size_t>(task);
        evaluate_some(evaluator, work, totals, starts[t], starts[t + 1], counts[t], shifts[t], seen[t]);
    };
    if (!parallel_for(static_cast<std::int64_t>(tasks), run, cancel)) return false;
    for (std::size_t t = 0; t < tasks; ++t) {
        non_finite.merge(counts[t]);
        shifted += shifts[t];
        for (std::size_t c = 0; c < nonzero.size(); ++c) nonzero[c] |= seen[t][c];
    }
    return true;
}

} // namespace montelux
