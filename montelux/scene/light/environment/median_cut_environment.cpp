#include "montelux/scene/light/environment/median_cut_environment.h"

#include <limits>

#include "montelux/mc/parallel/parallel_for.h"

namespace montelux {

namespace {

struct Rectangle {
    float x0, x1, y0, y1;
};

// How much of [a, b] lies in cell i.
double overlap(double a, double b, std::size_t i) {
    return std::max(0.0, std::min(b, static_cast<double>(i + 1)) - std::max(a, static_cast<double>(i)));
}

// Light of a rectangle summed over the columns and rows of texels that it touches.
struct Margins {
    std::size_t first_column, first_row;
    std::vector<double> columns, rows;
};

Margins margins_of(const Rectangle& r, const std::vector<float>& light, std::size_t width) {
    auto last = [](float end, float begin) {
        return std::max(static_cast<std::size_t>(std::ceil(end)), static_cast<std::size_t>(begin) + 1);
    };
    const auto c0 = static_cast<std::size_t>(r.x0), c1 = last(r.x1, r.x0);
    const auto r0 = static_cast<std::size_t>(r.y0), r1 = last(r.y1, r.y0);
    Margins m{c0, r0, std::vector<double>(c1 - c0), std::vector<double>(r1 - r0)};
    for (std::size_t y = r0; y < r1; ++y) {
        const double part = overlap(double(r.y0), double(r.y1), y);
        double sum = 0;
        for (std::size_t x = c0; x < c1; ++x) {
            const double v = part * static_cast<double>(light[y * width + x]);
            m.columns[x - c0] += v;
            sum += v * (x == c0 || x + 1 == c1 ? overlap(double(r.x0), double(r.x1), x) : 1.0);
        }
        m.rows[y - r0] = sum;
    }
    m.columns.front() *= overlap(double(r.x0), double(r.x1), c0);
    if (c1 - c0 > 1) m.columns.back() *= overlap(double(r.x0), double(r.x1), c1 - 1);
    return m;
}

// Trims the cells without light at the ends of [a, b].
void trim(float& a, float& b, const std::vector<double>& sums, std::size_t first) {
    std::size_t begin = 0, end = sums.size();
    while (begin < end && !(sums[begin] > 0)) ++begin;
    while (end > begin && !(sums[end - 1] > 0)) --end;
    if (begin == end) return;
    a = std::max(a, static_cast<float>(first + begin));
    b = std::min(b, static_cast<float>(first + end));
}

// The coordinate that halves the light.
float median(double a, double b, const std::vector<double>& sums, std::size_t first) {
    double total = 0, before = 0;
    for (double s : sums) total += s;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        if (before + sums[i] >= 0.5 * total && sums[i] > 0) {
            const double from = std::max(a, static_cast<double>(first + i));
            return static_cast<float>(from + (0.5 * total - before) / sums[i] * overlap(a, b, first + i));
        }
        before += sums[i];
    }
    return static_cast<float>(0.5 * (a + b));
}

// The side along x is the longer one, in angles.
bool wider_than_high(const Rectangle& r, const EnvironmentGrid& grid) {
    const double width = double(r.x1 - r.x0) / grid.width(), height = double(r.y1 - r.y0) / grid.height();
    if (grid.layout() == EnvironmentLayout::equal_area) return width >= height;
    const double middle = 0.5 * (double(r.y0) + double(r.y1)) / grid.height();
    return 2 * width * std::sin(pi * middle) >= height;
}

} // namespace

class MedianCutter {
  public:
    MedianCutter(MedianCutEnvironment& tree, const std::vector<float>& light) : tree_(tree), light_(light) {}

    // Everything below cut `index`; the first levels in parallel.
    void cut(std::size_t index, Rectangle r) const {
        const EnvironmentGrid& grid = *tree_.grid_;
        Margins m = margins_of(r, light_, static_cast<std::size_t>(grid.width()));
        const Rectangle whole = r;
        trim(r.x0, r.x1, m.columns, m.first_column);
        trim(r.y0, r.y1, m.rows, m.first_row);
        if (index >= tree_.regions_.size()) {
            fill(index, r, 1);
            return;
        }
        bool across_x = wider_than_high(r, grid);
        auto place = [&](bool x) {
            return x ? median(double(whole.x0), double(whole.x1), m.columns, m.first_column)
                     : median(double(whole.y0), double(whole.y1), m.rows, m.first_row);
        };
        float at = place(across_x);
        auto splits = [&] { return across_x ? at > r.x0 && at < r.x1 : at > r.y0 && at < r.y1; };
        if (!splits()) {
            across_x = !across_x;
            at = place(across_x);
        }
        if (!splits()) { // nothing between neighbouring numbers: all below is this one region
            fill(index, r, subtree(index));
            return;
        }
        tree_.cuts_[index] = {at, across_x};
        Rectangle low = r, high = r;
        (across_x ? low.x1 : low.y1) = at;
        (across_x ? high.x0 : high.y0) = at;
        auto side = [&](std::int64_t s) {
            cut(2 * index + static_cast<std::size_t>(s), s == 0 ? low : high);
        };
        if (index < 64) {
            parallel_for(2, side);
        } else {
            side(0);
            side(1);
        }
    }

  private:
    std::size_t subtree(std::size_t index) const {
        std::size_t leaves = 1;
        for (; index < tree_.regions_.size(); index *= 2) leaves *= 2;
        return leaves;
    }
    // `leaves` regions of the list are this rectangle.
    void fill(std::size_t index, const Rectangle& r, std::size_t leaves) const {
        const EnvironmentGrid& grid = *tree_.grid_;
        MedianCutEnvironment::Region region{
            r.x0, r.x1, r.y0, r.y1, grid.share_above(double(r.y0)), grid.share_above(double(r.y1)), 0};
        const double solid_angle =
            4 * pi * (region.share1 - region.share0) * double(r.x1 - r.x0) / grid.width();
        region.pdf = static_cast<float>(static_cast<double>(leaves) /
                                        (static_cast<double>(tree_.regions_.size()) * solid_angle));
        std::size_t first = index;
        while (first < tree_.regions_.size()) {
            for (std::size_t i = first, n = leaves_at(index, first); i < first + n; ++i)
                tree_.cuts_[i] = {std::numeric_limits<float>::infinity(), true};
            first *= 2;
        }
        std::fill_n(tree_.regions_.begin() + static_cast<std::ptrdiff_t>(first - tree_.regions_.size()),
                    leaves, region);
    }
    // Of the level that begins with `first`, how many cuts lie below `index`.
    static std::size_t leaves_at(std::size_t index, std::size_t first) { return first / index; }

    MedianCutEnvironment& tree_;
    const std::vector<float>& light_;
};

MedianCutEnvironment::MedianCutEnvironment(const EnvironmentGrid& grid, const std::vector<float>& light,
                                           int levels)
    : grid_(&grid), cuts_(std::size_t{1} << levels), regions_(std::size_t{1} << levels) {
    MedianCutter(*this, light)
        .cut(1, {0, static_cast<float>(grid.width()), 0, static_cast<float>(grid.height())});
}

} // namespace montelux
