#include "montelux/mc/dist/piecewise_bilinear_2d.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "montelux/mc/dist/weights.h"
#include "montelux/mc/math/error.h"

namespace montelux {

PiecewiseBilinear2D::PiecewiseBilinear2D(std::vector<float> x, std::vector<float> y,
                                         std::vector<float> values, std::span<const double> row_scale)
    : x_(std::move(x)), y_(std::move(y)), values_(std::move(values)),
      cells_(cells_of(x_, y_, values_, row_scale)), integral_(cells_.integral()) {}

PiecewiseConstant2D PiecewiseBilinear2D::cells_of(std::span<const float> x, std::span<const float> y,
                                                  std::span<const float> values,
                                                  std::span<const double> row_scale) {
    const char* where = "PiecewiseBilinear2D";
    auto increases = [](std::span<const float> knots) {
        return knots.size() >= 2 &&
               std::ranges::adjacent_find(knots, [](float a, float b) { return !(a < b); }) == knots.end();
    };
    if (!increases(x) || !increases(y)) throw Error(where, "expected at least two knots that increase");
    if (values.size() != x.size() * y.size()) {
        std::ostringstream what;
        what << "found " << values.size() << " values; expected one a knot, " << x.size() << " * "
             << y.size();
        throw Error(where, what.str());
    }
    if (!row_scale.empty() && row_scale.size() != y.size() - 1)
        throw Error(where, "expected one scale for each strip between knots of y");
    checked_weight_sum(where, values);
    const std::size_t columns = x.size() - 1, rows = y.size() - 1;
    std::vector<double> integrals(columns * rows);
    for (std::size_t j = 0; j < rows; ++j) {
        const float *top = &values[j * x.size()], *bottom = top + x.size();
        const double height = (static_cast<double>(y[j + 1]) - static_cast<double>(y[j])) *
                              (row_scale.empty() ? 1 : row_scale[j]);
        for (std::size_t i = 0; i < columns; ++i)
            integrals[j * columns + i] =
                height * (static_cast<double>(x[i + 1]) - static_cast<double>(x[i])) / 4 *
                (static_cast<double>(top[i]) + static_cast<double>(top[i + 1]) +
                 static_cast<double>(bottom[i]) + static_cast<double>(bottom[i + 1]));
    }
    return PiecewiseConstant2D(integrals, static_cast<std::uint32_t>(columns),
                               static_cast<std::uint32_t>(rows), {0, 0},
                               {static_cast<double>(columns), static_cast<double>(rows)});
}

} // namespace montelux
