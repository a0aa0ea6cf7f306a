#include "montelux/mc/dist/windowed_2d.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "montelux/mc/dist/weights.h"
#include "montelux/mc/math/error.h"

namespace montelux {

WindowedPiecewise2D::WindowedPiecewise2D(std::span<const double> values, std::uint32_t columns,
                                         std::uint32_t rows, const Window2D& domain)
    : columns_(columns), rows_(rows), domain_(domain) {
    const char* where = "WindowedPiecewise2D";
    const std::size_t cells = std::size_t{columns} * rows;
    if (values.size() != cells || cells > (std::size_t{1} << 31)) {
        std::ostringstream what;
        what << "found " << values.size() << " values; expected columns * rows = " << columns << " * " << rows
             << ", at most 2^31";
        throw Error(where, what.str());
    }
    const double total = checked_weight_sum(where, values);
    const Vec2d extent = domain.upper - domain.lower;
    if (!(extent.x > 0 && extent.y > 0 && std::isfinite(extent.x) && std::isfinite(extent.y)))
        throw Error(where, "the domain is empty or not finite");
    inv_cell_ = {columns / extent.x, rows / extent.y};

    const std::size_t stride = std::size_t{columns} + 1;
    sums_.assign(stride * (std::size_t{rows} + 1), 0);
    for (std::size_t y = 0; y < rows; ++y) {
        std::uint64_t row = 0;
        for (std::size_t x = 0; x < columns; ++x) {
            const double value = values[y * columns + x];
            if (!(total > 0))
                row += 1;
            else if (value > 0)
                row += std::max<std::uint64_t>(1, static_cast<std::uint64_t>(value / total * 0x1p62));
            sums_[(y + 1) * stride + x + 1] = sums_[y * stride + x + 1] + row;
        }
    }
}

std::optional<WindowedPiecewise2D::Range> WindowedPiecewise2D::range(double begin, double end,
                                                                     std::uint32_t cells) {
    begin = std::max(begin, 0.0);
    end = std::min(end, static_cast<double>(cells));
    if (!(begin < end)) return std::nullopt;
    Range r{.first = static_cast<std::uint32_t>(begin),
            .last = static_cast<std::uint32_t>(std::ceil(end)) - 1,
            .head = end - begin,
            .tail = 0,
            .begin = begin,
            .end = end};
    if (r.last > r.first) {
        r.head = r.first + 1 - begin;
        r.tail = end - r.last;
    }
    return r;
}

std::optional<WindowedPiecewise2D::Ranges> WindowedPiecewise2D::ranges(const Window2D& window) const {
    const auto x = range((window.lower.x - domain_.lower.x) * inv_cell_.x,
                         (window.upper.x - domain_.lower.x) * inv_cell_.x, columns_);
    const auto y = range((window.lower.y - domain_.lower.y) * inv_cell_.y,
                         (window.upper.y - domain_.lower.y) * inv_cell_.y, rows_);
    if (!x || !y) return std::nullopt;
    return Ranges{*x, *y};
}

template <typename Sum>
double WindowedPiecewise2D::total(const Range& r, const Sum& sum) {
    double t = r.head * sum(r.first, r.first + 1);
    if (r.last > r.first) t += sum(r.first + 1, r.last) + r.tail * sum(r.last, r.last + 1);
    return t;
}

// The total must be above zero. No cell without weight is drawn: v stays below the total, and the sums before
// a cell and behind it differ where v lies between them.
template <typename Sum>
WindowedPiecewise2D::Drawn WindowedPiecewise2D::draw(double u, const Range& r, const Sum& sum) {
    const double first = r.head * sum(r.first, r.first + 1);
    const double middle = r.last > r.first ? sum(r.first + 1, r.last) : 0;
    const double last = r.last > r.first ? r.tail * sum(r.last, r.last + 1) : 0;
    const double all = first + middle + last;
    const double v = std::min(u * all, std::nextafter(all, 0.0));
    auto at = [](double from, double width, double fraction) {
        return from + width * std::clamp(fraction, 0.0, 1.0);
    };
    if (v < first) return {r.first, at(r.begin, r.head, v / first)};
    if (!(v < first + middle)) return {r.last, at(r.last, r.tail, (v - (first + middle)) / last)};
    std::uint32_t low = r.first + 1, high = r.last; // first + sum before low <= v < first + sum before high
    while (high - low > 1) {
        const std::uint32_t half = low + (high - low) / 2;
        (first + sum(r.first + 1, half) <= v ? low : high) = half;
    }
    return {low, at(low, 1, (v - (first + sum(r.first + 1, low))) / sum(low, low + 1))};
}

std::optional<WindowedSample2D> WindowedPiecewise2D::sample(Vec2d u, const Window2D& window) const {
    const auto r = ranges(window);
    if (!r) return std::nullopt;
    const Columns columns = columns_within(r->y);
    const double all = total(r->x, columns);
    if (!(all > 0)) return std::nullopt;
    const Drawn x = draw(u.x, r->x, columns);
    const Drawn y = draw(u.y, r->y, [&](std::uint32_t y0, std::uint32_t y1) {
        return rectangle(x.index, x.index + 1, y0, y1);
    });
    const double value = rectangle(x.index, x.index + 1, y.index, y.index + 1);
    return WindowedSample2D{
        {domain_.lower.x + x.place / inv_cell_.x, domain_.lower.y + y.place / inv_cell_.y},
        value / all * inv_cell_.x * inv_cell_.y};
}

double WindowedPiecewise2D::pdf(Vec2d p, const Window2D& window) const {
    if (!window.contains(p) || !domain_.contains(p)) return 0;
    const auto r = ranges(window);
    if (!r) return 0;
    const double all = total(r->x, columns_within(r->y));
    if (!(all > 0)) return 0;
    const std::uint32_t x =
        std::min(static_cast<std::uint32_t>((p.x - domain_.lower.x) * inv_cell_.x), columns_ - 1);
    const std::uint32_t y =
        std::min(static_cast<std::uint32_t>((p.y - domain_.lower.y) * inv_cell_.y), rows_ - 1);
    return rectangle(x, x + 1, y, y + 1) / all * inv_cell_.x * inv_cell_.y;
}

} // namespace montelux
