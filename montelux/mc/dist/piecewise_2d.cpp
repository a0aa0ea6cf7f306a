#include "montelux/mc/dist/piecewise_2d.h"

#include <cmath>
#include <sstream>

#include "montelux/mc/dist/weights.h"
#include "montelux/mc/math/compensated.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// Starts of the shares of `whole` units that the weights take: at least one unit for any weight above
// zero, none for zero; shares are equal when all weights are zero.
template <typename T>
void fixed_point_cdf(std::span<const T> weights, double sum, std::uint64_t whole, std::uint32_t* starts) {
    std::size_t n = weights.size();
    auto share = [&](std::size_t i) {
        return sum > 0 ? static_cast<double>(weights[i]) / sum : 1 / static_cast<double>(n);
    };
    std::uint64_t drawable = 0;
    for (std::size_t i = 0; i < n; ++i) drawable += share(i) > 0;
    // One unit is set aside for each cell that can be drawn, the rest is dealt out in proportion.
    double dealt = static_cast<double>(whole - drawable);
    CompensatedSum before;
    std::uint64_t set_aside = 0;
    for (std::size_t i = 0; i < n; ++i) {
        std::uint64_t start = whole;
        if (set_aside < drawable)
            start = static_cast<std::uint64_t>(std::min(1.0, before.value()) * dealt) + set_aside;
        starts[i] = static_cast<std::uint32_t>(std::min(start, whole));
        before.add(share(i));
        set_aside += share(i) > 0;
    }
}

} // namespace

PiecewiseConstant2D::PiecewiseConstant2D(std::span<const float> values, std::uint32_t columns,
                                         std::uint32_t rows, Vec2d lower, Vec2d upper)
    : columns_(columns), rows_(rows), lower_(lower), upper_(upper) {
    build(values);
}
PiecewiseConstant2D::PiecewiseConstant2D(std::span<const double> values, std::uint32_t columns,
                                         std::uint32_t rows, Vec2d lower, Vec2d upper)
    : columns_(columns), rows_(rows), lower_(lower), upper_(upper) {
    build(values);
}

void PiecewiseConstant2D::build_guide(const std::uint32_t* cdf, std::uint32_t n, std::uint32_t* guide) {
    std::uint64_t parts = guide_parts(n);
    std::uint32_t i = 0;
    for (std::uint64_t g = 0; g < parts; ++g) {
        std::uint64_t start = ((g << 32) + parts - 1) / parts; // the least fraction that falls in this part
        while (i + 1 < n && cdf[i + 1] <= start) ++i;
        guide[g] = i;
    }
    guide[parts] = n - 1;
}

template <typename T>
void PiecewiseConstant2D::build(std::span<const T> values) {
    const char* where = "PiecewiseConstant2D";
    std::size_t cells = std::size_t{columns_} * rows_;
    if (values.size() != cells || cells > (std::size_t{1} << 31)) {
        std::ostringstream what;
        what << "found " << values.size() << " values; expected columns * rows = " << columns_ << " * "
             << rows_ << ", at most 2^31";
        throw Error(where, what.str());
    }
    double total = checked_weight_sum(where, values);
    Vec2d extent = upper_ - lower_;
    if (!(extent.x > 0 && extent.y > 0 && std::isfinite(extent.x) && std::isfinite(extent.y)))
        throw Error(where, "the domain is empty or not finite");
    cell_ = {extent.x / columns_, extent.y / rows_};
    inv_cell_ = {columns_ / extent.x, rows_ / extent.y};
    inv_cell_area_ = inv_cell_.x * inv_cell_.y;
    integral_ = total / inv_cell_area_;

    conditional_.resize(cells);
    marginal_.resize(rows_);
    conditional_guide_.resize(std::size_t{rows_} * guide_entries(columns_));
    marginal_guide_.resize(guide_entries(rows_));
    std::vector<double> row_sums(rows_);
    for (std::size_t j = 0; j < rows_; ++j) {
        std::span<const T> row = values.subspan(j * columns_, columns_);
        CompensatedSum sum;
        for (T v : row) sum.add(static_cast<double>(v));
        row_sums[j] = sum.value();
        fixed_point_cdf(row, row_sums[j], whole, conditional_.data() + j * columns_);
        build_guide(conditional_.data() + j * columns_, columns_,
                    conditional_guide_.data() + j * guide_entries(columns_));
    }
    fixed_point_cdf(std::span<const double>(row_sums), total, whole, marginal_.data());
    build_guide(marginal_.data(), rows_, marginal_guide_.data());
}

} // namespace montelux
