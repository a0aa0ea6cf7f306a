// A tabulated density on a rectangle, restricted to a window that each sample chooses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "montelux/mc/math/vec.h"

namespace montelux {

// The rectangle [lower, upper) of a plane; empty where upper is not above lower.
struct Window2D {
    Vec2d lower, upper;

    bool contains(Vec2d p) const {
        return p.x >= lower.x && p.x < upper.x && p.y >= lower.y && p.y < upper.y;
    }
};

// A point and its density per unit area.
struct WindowedSample2D {
    Vec2d p;
    double pdf = 0;
};

// columns x rows cells of equal size on a domain; within a window the density on cell (column, row) is
// proportional to values[row * columns + column], and zero outside. u.x picks the column, u.y the row within
// it. Bitterli, Novak, Jarosz 2015, "Portal-Masked Environment Map Sampling".
//
// The summed-area table (Crow 1984, "Summed-Area Tables for Texture Mapping") holds 64-bit fixed-point
// fractions, eight bytes a cell: the sum over a small window is a difference of large numbers, and so is
// exact. A cell whose value is not zero keeps at least 2^-62 of the whole; a value of zero is never drawn.
// Values that are all zero give the uniform density. Throws Error when the number of values is not
// columns * rows or exceeds 2^31, when one is negative or not finite, or when the domain is empty.
class WindowedPiecewise2D {
  public:
    WindowedPiecewise2D(std::span<const double> values, std::uint32_t columns, std::uint32_t rows,
                        const Window2D& domain = {{0, 0}, {1, 1}});

    std::uint32_t columns() const { return columns_; }
    std::uint32_t rows() const { return rows_; }
    const Window2D& domain() const { return domain_; }
    std::size_t bytes() const { return sums_.size() * sizeof(std::uint64_t); }

    // Empty where the window, as far as it lies in the domain, holds nothing.
    std::optional<WindowedSample2D> sample(Vec2d u, const Window2D& window) const;
    // Zero outside the window, and everywhere where `sample` is empty.
    double pdf(Vec2d p, const Window2D& window) const;

  private:
    // Cells first ... last of an axis; of the first and last one the parts `head` and `tail` lie in the
    // window, which is [begin, end) in cells. A window within one cell has all of it in `head`.
    struct Range {
        std::uint32_t first, last;
        double head, tail, begin, end;
    };
    struct Drawn {
        std::uint32_t index;
        double place; // in cells
    };
    static std::optional<Range> range(double begin, double end, std::uint32_t cells);
    struct Ranges {
        Range x, y;
    };
    std::optional<Ranges> ranges(const Window2D& window) const;

    double rectangle(std::uint32_t x0, std::uint32_t x1, std::uint32_t y0, std::uint32_t y1) const {
        const std::uint64_t *top = &sums_[std::size_t{y0} * (columns_ + std::size_t{1})],
                            *bottom = &sums_[std::size_t{y1} * (columns_ + std::size_t{1})];
        return static_cast<double>(bottom[x1] - bottom[x0] - top[x1] + top[x0]);
    }
    // Sums of columns within the rows of a window, by the four lines of the table around its first and last
    // row.
    struct Columns {
        const std::uint64_t *first_top, *first_bottom, *last_top, *last_bottom;
        double head, tail;
        double operator()(std::uint32_t x0, std::uint32_t x1) const {
            auto above = [=](const std::uint64_t* line) { return line[x1] - line[x0]; };
            const std::uint64_t bottom = above(first_bottom), top = above(last_top);
            return head * static_cast<double>(bottom - above(first_top)) +
                   (tail > 0 ? static_cast<double>(top - bottom) +
                                   tail * static_cast<double>(above(last_bottom) - top)
                             : 0);
        }
    };
    Columns columns_within(const Range& rows) const {
        auto line = [this](std::uint32_t y) { return &sums_[std::size_t{y} * (columns_ + std::size_t{1})]; };
        return {line(rows.first), line(rows.first + 1), line(rows.last), line(rows.last + 1), rows.head,
                rows.tail};
    }
    // Of everything in a range, by the sum(first, end) of whole cells.
    template <typename Sum>
    static double total(const Range& range, const Sum& sum);
    template <typename Sum>
    static Drawn draw(double u, const Range& range, const Sum& sum);

    std::uint32_t columns_, rows_;
    Window2D domain_;
    Vec2d inv_cell_;
    std::vector<std::uint64_t> sums_; // of all cells left of x and above y, at y * (columns + 1) + x
};

} // namespace montelux
