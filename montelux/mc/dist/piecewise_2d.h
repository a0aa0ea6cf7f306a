// Tabulated densities on a rectangle, piecewise constant: marginal row first, then the column within it.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "montelux/mc/dist/discrete.h"
#include "montelux/mc/math/vec.h"

namespace montelux {

// A point, its density per unit area of the domain, and its cell.
template <std::floating_point T = float>
struct PiecewiseSample2D {
    Vec2<T> p;
    T pdf = 0;
    std::uint32_t column = 0, row = 0;
};

// columns x rows cells of equal size on [lower, upper); the density on cell (column, row) is proportional
// to values[row * columns + column]. u.y picks the row, u.x the column.
//
// Cumulative sums are kept as 32-bit fixed-point fractions, four bytes a cell (and half a byte
// for the search), and the density that is reported is the one that these fractions sample: the two agree
// exactly, however large the table. A cell whose value is not zero keeps at least 2^-32 of its row, and its
// row as much of the whole, so nothing that contributes is left out; a value of zero is never drawn. Values
// that are all zero give the uniform density, with integral() 0. Throws Error when the number of values is
// not columns * rows or exceeds 2^31, when one is negative or not finite, or when the domain is empty.
class PiecewiseConstant2D {
  public:
    PiecewiseConstant2D(std::span<const float> values, std::uint32_t columns, std::uint32_t rows,
                        Vec2d lower = {0, 0}, Vec2d upper = {1, 1});
    PiecewiseConstant2D(std::span<const double> values, std::uint32_t columns, std::uint32_t rows,
                        Vec2d lower = {0, 0}, Vec2d upper = {1, 1});

    std::uint32_t columns() const { return columns_; }
    std::uint32_t rows() const { return rows_; }
    Vec2d lower() const { return lower_; }
    Vec2d upper() const { return upper_; }
    // Of the tabulated function over the domain.
    double integral() const { return integral_; }
    std::size_t bytes() const {
        return sizeof(std::uint32_t) *
               (marginal_.size() + conditional_.size() + marginal_guide_.size() + conditional_guide_.size());
    }

    template <std::floating_point T>
    PiecewiseSample2D<T> sample(Vec2<T> u) const {
        Drawn row = draw(marginal_.data(), marginal_guide_.data(), rows_, static_cast<double>(u.y));
        const std::uint32_t* guide =
            conditional_guide_.data() + std::size_t{row.index} * guide_entries(columns_);
        Drawn column = draw(row_cdf(row.index), guide, columns_, static_cast<double>(u.x));
        double x = lower_.x + (column.index + column.within) * cell_.x;
        double y = lower_.y + (row.index + row.within) * cell_.y;
        return {{keep_below(static_cast<T>(x), static_cast<T>(upper_.x)),
                 keep_below(static_cast<T>(y), static_cast<T>(upper_.y))},
                static_cast<T>(row.probability * column.probability * inv_cell_area_),
                column.index,
                row.index};
    }
    // Zero outside the domain.
    template <std::floating_point T>
    T pdf(Vec2<T> p) const {
        double sx = (static_cast<double>(p.x) - lower_.x) * inv_cell_.x;
        double sy = (static_cast<double>(p.y) - lower_.y) * inv_cell_.y;
        if (!inside(sx, sy)) return 0;
        std::uint32_t i = std::min(static_cast<std::uint32_t>(sx), columns_ - 1);
        std::uint32_t j = std::min(static_cast<std::uint32_t>(sy), rows_ - 1);
        return static_cast<T>(width(row_cdf(j), columns_, i) * width(marginal_.data(), rows_, j) *
                              inv_cell_area_);
    }
    // Density of one cell, per unit area of the domain.
    double cell_pdf(std::uint32_t column, std::uint32_t row) const {
        return width(row_cdf(row), columns_, column) * width(marginal_.data(), rows_, row) * inv_cell_area_;
    }
    // The u that `sample` maps to p; empty outside the domain and in cells that are never drawn.
    template <std::floating_point T>
    std::optional<Vec2<T>> inverse(Vec2<T> p) const {
        double sx = (static_cast<double>(p.x) - lower_.x) * inv_cell_.x;
        double sy = (static_cast<double>(p.y) - lower_.y) * inv_cell_.y;
        if (!inside(sx, sy)) return std::nullopt;
        std::uint32_t i = std::min(static_cast<std::uint32_t>(sx), columns_ - 1);
        std::uint32_t j = std::min(static_cast<std::uint32_t>(sy), rows_ - 1);
        const std::uint32_t* row = row_cdf(j);
        double px = width(row, columns_, i), py = width(marginal_.data(), rows_, j);
        if (!(px > 0 && py > 0)) return std::nullopt;
        return Vec2<T>{static_cast<T>(row[i] * unit + (sx - i) * px),
                       static_cast<T>(marginal_[j] * unit + (sy - j) * py)};
    }

  private:
    // Fractions count units of 1 / whole; `whole` itself has a 32-bit entry, where cells that are never
    // drawn can start after the last one that is.
    static constexpr std::uint64_t whole = 0xffffffff;
    static constexpr double unit = 1 / static_cast<double>(whole);

    struct Drawn {
        std::uint32_t index;
        double probability, within;
    };
    // Table entries are the starts of the cells; the last one ends at `whole`.
    static double width(const std::uint32_t* cdf, std::uint32_t n, std::uint32_t i) {
        std::uint64_t end = i + 1 < n ? cdf[i + 1] : whole;
        return static_cast<double>(end - cdf[i]) * unit;
    }
    // Guide tables (Chen and Asau 1974, "On Generating Random Variates from an Empirical Distribution") cut
    // [0, 1) into parts, about one for each eight cells, and say where each part starts: bisection is left
    // with the few cells in between, and a large table with few cache misses.
    static constexpr std::uint32_t guide_parts(std::uint32_t n) { return n / 8 + 1; }
    static constexpr std::uint32_t guide_entries(std::uint32_t n) { return guide_parts(n) + 1; }
    static void build_guide(const std::uint32_t* cdf, std::uint32_t n, std::uint32_t* guide);
    static Drawn draw(const std::uint32_t* cdf, const std::uint32_t* guide, std::uint32_t n, double u) {
        double v = u * static_cast<double>(whole);
        auto fixed = static_cast<std::uint32_t>(std::min(static_cast<std::uint64_t>(v), whole - 1));
        auto part = static_cast<std::uint32_t>((std::uint64_t{fixed} * guide_parts(n)) >> 32);
        std::uint32_t first = guide[part], last = guide[part + 1];
        auto i =
            first + static_cast<std::uint32_t>(find_last_not_above(cdf + first, last - first + 1, fixed));
        double p = width(cdf, n, i);
        return {i, p, std::min((v - cdf[i]) * unit / p, 1.0)};
    }
    bool inside(double sx, double sy) const { return sx >= 0 && sx <= columns_ && sy >= 0 && sy <= rows_; }
    const std::uint32_t* row_cdf(std::uint32_t row) const {
        return conditional_.data() + std::size_t{row} * columns_;
    }
    template <typename T>
    void build(std::span<const T> values);

    std::uint32_t columns_, rows_;
    Vec2d lower_, upper_, cell_, inv_cell_;
    double inv_cell_area_ = 0, integral_ = 0;
    std::vector<std::uint32_t> marginal_;    // rows_ entries
    std::vector<std::uint32_t> conditional_; // rows_ x columns_
    std::vector<std::uint32_t> marginal_guide_, conditional_guide_;
};

} // namespace montelux
