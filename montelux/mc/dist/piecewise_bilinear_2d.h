// Tabulated densities on a rectangle, bilinear between the knots of a grid.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/dist/piecewise_2d.h"
#include "montelux/mc/dist/search.h"
#include "montelux/mc/math/vec.h"
#include "montelux/mc/warp/linear.h"

namespace montelux {

// Between knots (x[i], y[j]) the density is proportional to the bilinear interpolation of
// values[j * x.size() + i], times row_scale[j] in the strip y[j] ... y[j + 1] (1 where it is empty). u.y
// picks the strip and the place across it, u.x those along it.
//
// Cells are drawn from a PiecewiseConstant2D of their integrals, and the density that is reported is the one
// that is drawn. Values that are all zero give the uniform density over cells, with integral() 0. Throws
// Error when the numbers of values do not fit, knots do not increase, or a value is negative or not finite.
class PiecewiseBilinear2D {
  public:
    PiecewiseBilinear2D(std::vector<float> x, std::vector<float> y, std::vector<float> values,
                        std::span<const double> row_scale = {});

    // Of the tabulated function over the domain.
    double integral() const { return integral_; }
    std::size_t bytes() const {
        return cells_.bytes() + (x_.size() + y_.size() + values_.size()) * sizeof(float);
    }

    // The cell is that of knots (column, row) and the next ones.
    PiecewiseSample2D<float> sample(Vec2f u) const {
        const auto cell = cells_.sample(Vec2d(u));
        const std::array<double, 4> f = corners(cell.column, cell.row);
        const Vec2d lower{static_cast<double>(x_[cell.column]), static_cast<double>(y_[cell.row])};
        const Vec2d upper{static_cast<double>(x_[cell.column + 1]), static_cast<double>(y_[cell.row + 1])};
        const Vec2d t = sample_bilinear(Vec2d{cell.p.x - cell.column, cell.p.y - cell.row}, f);
        const Vec2d size = upper - lower;
        return {{static_cast<float>(lower.x + t.x * size.x), static_cast<float>(lower.y + t.y * size.y)},
                static_cast<float>(cell.pdf * bilinear_pdf(t, f) / (size.x * size.y)),
                cell.column,
                cell.row};
    }
    // The strip between knots that holds y, or the nearest one.
    std::uint32_t row_of(float y) const {
        return static_cast<std::uint32_t>(find_last_not_above(y_.data(), y_.size() - 1, y));
    }
    // Zero outside the domain.
    float pdf(Vec2f p) const {
        if (!(p.x >= x_.front() && p.x <= x_.back() && p.y >= y_.front() && p.y <= y_.back())) return 0;
        const auto i = static_cast<std::uint32_t>(find_last_not_above(x_.data(), x_.size() - 1, p.x));
        const std::uint32_t j = row_of(p.y);
        const Vec2d lower{static_cast<double>(x_[i]), static_cast<double>(y_[j])};
        const Vec2d size = Vec2d{static_cast<double>(x_[i + 1]), static_cast<double>(y_[j + 1])} - lower;
        const Vec2d t{(static_cast<double>(p.x) - lower.x) / size.x,
                      (static_cast<double>(p.y) - lower.y) / size.y};
        return static_cast<float>(cells_.cell_pdf(i, j) * bilinear_pdf(t, corners(i, j)) / (size.x * size.y));
    }

  private:
    static PiecewiseConstant2D cells_of(std::span<const float> x, std::span<const float> y,
                                        std::span<const float> values, std::span<const double> row_scale);
    // Equal ones where all are zero.
    std::array<double, 4> corners(std::uint32_t i, std::uint32_t j) const {
        const float *top = &values_[j * x_.size() + i], *bottom = top + x_.size();
        std::array<double, 4> f{static_cast<double>(top[0]), static_cast<double>(top[1]),
                                static_cast<double>(bottom[0]), static_cast<double>(bottom[1])};
        if (!(f[0] + f[1] + f[2] + f[3] > 0)) f = {1, 1, 1, 1};
        return f;
    }

    std::vector<float> x_, y_, values_;
    PiecewiseConstant2D cells_; // cell (i, j) is the unit square at (i, j)
    double integral_ = 0;
};

} // namespace montelux
