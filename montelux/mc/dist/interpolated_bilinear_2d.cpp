#include "montelux/mc/dist/interpolated_bilinear_2d.h"

#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include "montelux/mc/dist/search.h"
#include "montelux/mc/dist/weights.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/warp/linear.h"

namespace montelux {
namespace {

struct KnotInterval {
    std::size_t index;
    float fraction; // 0 where only the first knot counts
};
KnotInterval knot_interval(const std::vector<float>& knots, float x) {
    if (knots.size() == 1 || !(x > knots.front())) return {0, 0};
    if (x >= knots.back()) return {knots.size() - 1, 0};
    const std::size_t i = find_last_not_above(knots.data(), knots.size() - 1, x);
    return {i, (x - knots[i]) / (knots[i + 1] - knots[i])};
}

// The largest i in [0, n - 2] with f(i) <= x, or 0.
template <typename F>
std::uint32_t last_not_above(std::uint32_t n, float x, const F& f) {
    std::uint32_t low = 0, high = n - 1;
    while (high - low > 1) {
        const std::uint32_t middle = (low + high) / 2;
        (f(middle) <= x ? low : high) = middle;
    }
    return low;
}

// The place in a cell of the width 1 / (n - 1) where a linear density of the values a and b at its ends has the
// integral `mass` from its beginning.
float place_in_cell(float mass, float a, float b, std::uint32_t n) {
    const float u = mass * static_cast<float>(n - 1) / (0.5f * (a + b));
    return a + b > 0 ? sample_linear(std::clamp(u, 0.0f, 1.0f), a, b) : 0.5f;
}
float mass_in_cell(float x, float a, float b, std::uint32_t n) {
    return x * (a + 0.5f * x * (b - a)) / static_cast<float>(n - 1);
}

} // namespace

InterpolationWeights interpolation_weights(const std::vector<float>& first, const std::vector<float>& second,
                                           float at_first, float at_second) {
    const KnotInterval a = knot_interval(first, at_first), b = knot_interval(second, at_second);
    InterpolationWeights w;
    for (std::size_t i = 0; i <= (a.fraction > 0 ? 1u : 0u); ++i)
        for (std::size_t j = 0; j <= (b.fraction > 0 ? 1u : 0u); ++j) {
            w.entry[w.count] = (a.index + i) * second.size() + b.index + j;
            w.weight[w.count++] =
                (i == 0 ? 1 - a.fraction : a.fraction) * (j == 0 ? 1 - b.fraction : b.fraction);
        }
    return w;
}

InterpolatedBilinear2D::InterpolatedBilinear2D(std::size_t entries, std::uint32_t columns, std::uint32_t rows,
                                               std::vector<float> values)
    : columns_(columns), rows_(rows), values_(std::move(values)) {
    const char* where = "InterpolatedBilinear2D";
    if (columns < 2 || rows < 2) throw Error(where, "expected at least 2 columns and 2 rows");
    const std::size_t knots = std::size_t{columns} * rows;
    if (entries == 0 || values_.size() != entries * knots)
        throw Error(where, "found " + std::to_string(values_.size()) + " values; expected " +
                               std::to_string(entries) + " * " + std::to_string(rows) + " * " +
                               std::to_string(columns));
    checked_weight_sum(where, values_);
    row_cdf_.resize(values_.size());
    marginal_.resize(entries * rows);
    for (std::size_t e = 0; e < entries; ++e) {
        const std::span<float> density(&values_[e * knots], knots);
        if (std::all_of(density.begin(), density.end(), [](float v) { return v == 0; }))
            std::fill(density.begin(), density.end(), 1.0f);
        const double total = integrate(e);
        for (float& v : density) v = static_cast<float>(static_cast<double>(v) / total);
        integrate(e);
    }
}

double InterpolatedBilinear2D::integrate(std::size_t entry) {
    const std::size_t first = entry * columns_ * rows_;
    double total = 0, previous = 0;
    for (std::size_t j = 0; j < rows_; ++j) {
        const std::size_t row = first + j * columns_;
        double sum = 0;
        row_cdf_[row] = 0;
        for (std::size_t i = 1; i < columns_; ++i) {
            sum += 0.5 * (static_cast<double>(values_[row + i - 1]) + static_cast<double>(values_[row + i])) /
                   (columns_ - 1);
            row_cdf_[row + i] = static_cast<float>(sum);
        }
        if (j > 0) total += 0.5 * (previous + sum) / (rows_ - 1);
        previous = sum;
        marginal_[entry * rows_ + j] = static_cast<float>(total);
    }
    return total;
}

InterpolatedBilinear2D::Cell InterpolatedBilinear2D::cell(float x, std::uint32_t n) {
    const float scaled = std::clamp(x, 0.0f, 1.0f) * static_cast<float>(n - 1);
    const std::uint32_t i = std::min(static_cast<std::uint32_t>(scaled), n - 2);
    return {i, scaled - static_cast<float>(i)};
}

InterpolatedBilinear2D::Sample InterpolatedBilinear2D::sample(const InterpolationWeights& at, Vec2f u) const {
    const auto marginal = [&](std::uint32_t j) { return mean(marginal_, at, rows_, j); };
    const float v = u.y * marginal(rows_ - 1);
    const std::uint32_t j = last_not_above(rows_, v, marginal);
    const float low = along(row_cdf_, at, columns_ - 1, j, 0), high = along(row_cdf_, at, columns_ - 1, j, 1);
    const float y = place_in_cell(v - marginal(j), low, high, rows_);

    const auto row_cdf = [&](std::uint32_t i) { return along(row_cdf_, at, i, j, y); };
    const float w = u.x * row_cdf(columns_ - 1);
    const std::uint32_t i = last_not_above(columns_, w, row_cdf);
    const float left = along(values_, at, i, j, y), right = along(values_, at, i + 1, j, y);
    const float x = place_in_cell(w - row_cdf(i), left, right, columns_);
    return {{(static_cast<float>(i) + x) / static_cast<float>(columns_ - 1),
             (static_cast<float>(j) + y) / static_cast<float>(rows_ - 1)},
            left + x * (right - left)};
}

InterpolatedBilinear2D::Sample InterpolatedBilinear2D::invert(const InterpolationWeights& at, Vec2f p) const {
    const auto [i, x] = cell(p.x, columns_);
    const auto [j, y] = cell(p.y, rows_);
    const float left = along(values_, at, i, j, y), right = along(values_, at, i + 1, j, y);
    const float row = along(row_cdf_, at, columns_ - 1, j, y);
    const float low = along(row_cdf_, at, columns_ - 1, j, 0), high = along(row_cdf_, at, columns_ - 1, j, 1);
    // In a row without mass any u.x will do.
    const float ux =
        row > 0 ? (along(row_cdf_, at, i, j, y) + mass_in_cell(x, left, right, columns_)) / row : p.x;
    const float uy = (mean(marginal_, at, rows_, j) + mass_in_cell(y, low, high, rows_)) /
                     mean(marginal_, at, rows_, rows_ - 1);
    return {{std::clamp(ux, 0.0f, 1.0f), std::clamp(uy, 0.0f, 1.0f)}, left + x * (right - left)};
}

float InterpolatedBilinear2D::pdf(const InterpolationWeights& at, Vec2f p) const {
    const auto [i, x] = cell(p.x, columns_);
    const auto [j, y] = cell(p.y, rows_);
    const float left = along(values_, at, i, j, y), right = along(values_, at, i + 1, j, y);
    return left + x * (right - left);
}

} // namespace montelux
