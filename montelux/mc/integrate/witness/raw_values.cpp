#include "montelux/mc/integrate/witness/raw_values.h"

#include <cmath>
#include <cstddef>
#include <utility>

#include "montelux/mc/integrate/infinity.h"

namespace montelux {
namespace {

// Values near the limit of IntegrandScale were larger: infinite, as far as a look can tell.
double unlimited(double value) {
    constexpr double far = 0x1p890;
    return std::abs(value) > far ? std::copysign(infinity, value) : value;
}

} // namespace

std::vector<std::vector<double>> RawValues::operator()(const std::vector<std::vector<double>>& points) {
    std::vector<std::vector<double>> rows(points.size());
    if (points.empty()) return rows;
    const int n = evaluator_.dimensions(), m = evaluator_.components();
    PointBuffer u(points.size(), n), x(points.size(), evaluator_.domain().dimensions());
    for (std::size_t i = 0; i < points.size(); ++i)
        for (int d = 0; d < n; ++d) u(i, d) = points[i][static_cast<std::size_t>(d)];
    std::vector<double> volume(points.size(), 1.0);
    evaluator_.domain().map(u, x, volume);
    ValueBuffer f(points.size(), m);
    evaluator_.integrand()(x, f);
    evaluations_ += points.size();
    for (std::size_t i = 0; i < points.size(); ++i)
        for (int c = 0; c < m; ++c) {
            const double value = std::as_const(f)(i, c);
            rows[i].push_back(value == 0 ? 0 : unlimited(value * volume[i]));
        }
    return rows;
}

std::vector<std::vector<double>> RawValues::at(const std::vector<std::vector<double>>& points) {
    std::vector<std::vector<double>> rows(points.size());
    if (points.empty()) return rows;
    const int n = evaluator_.domain().dimensions(), m = evaluator_.components();
    PointBuffer x(points.size(), n);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (int d = 0; d < n; ++d) x(i, d) = points[i][static_cast<std::size_t>(d)];
    ValueBuffer f(points.size(), m);
    evaluator_.integrand()(x, f);
    evaluations_ += points.size();
    for (std::size_t i = 0; i < points.size(); ++i)
        for (int c = 0; c < m; ++c) rows[i].push_back(unlimited(std::as_const(f)(i, c)));
    return rows;
}

} // namespace montelux
