#include "montelux/mc/random/discrepancy.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "montelux/mc/math/compensated.h"
#include "montelux/mc/math/error.h"

namespace montelux {

double star_discrepancy(std::span<const double> points) {
    if (points.empty()) return 1;
    std::vector<double> x(points.begin(), points.end());
    std::sort(x.begin(), x.end());
    const double n = static_cast<double>(x.size());
    double largest = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
        largest = std::max(largest, std::abs(x[i] - (static_cast<double>(i) + 0.5) / n));
    return 0.5 / n + largest;
}

double star_discrepancy(std::span<const Vec2d> points) {
    if (points.empty()) return 1;
    std::vector<Vec2d> p(points.begin(), points.end());
    std::sort(p.begin(), p.end(), [](Vec2d a, Vec2d b) { return a.x < b.x; });
    const std::size_t count = p.size();
    const double n = static_cast<double>(count);
    std::vector<double> y = {0, 1}; // of the first l points, sorted, between sentinels
    double largest = 0;
    for (std::size_t l = 0; l <= count; ++l) {
        if (l > 0) y.insert(std::upper_bound(y.begin() + 1, y.end() - 1, p[l - 1].y), p[l - 1].y);
        const double x = l == 0 ? 0 : p[l - 1].x, next_x = l == count ? 1 : p[l].x;
        for (std::size_t k = 0; k <= l; ++k) {
            const double share = static_cast<double>(k) / n;
            largest = std::max({largest, std::abs(share - x * y[k]), std::abs(share - next_x * y[k + 1])});
        }
    }
    return largest;
}

double l2_star_discrepancy(std::span<const double> points, int dimensions) {
    if (dimensions < 1 || points.empty() || points.size() % dimensions != 0)
        throw Error("l2_star_discrepancy", std::to_string(points.size()) + " coordinates in " +
                                               std::to_string(dimensions) +
                                               " dimensions; expected a positive multiple");
    const std::size_t d = dimensions, count = points.size() / d;
    const double n = static_cast<double>(count);
    CompensatedSum single, pairs;
    for (std::size_t i = 0; i < count; ++i) {
        double product = 1;
        for (std::size_t k = 0; k < d; ++k) product *= 1 - points[i * d + k] * points[i * d + k];
        single.add(product);
        for (std::size_t j = 0; j < count; ++j) {
            product = 1;
            for (std::size_t k = 0; k < d; ++k) product *= 1 - std::max(points[i * d + k], points[j * d + k]);
            pairs.add(product);
        }
    }
    const double squared =
        std::pow(3.0, -dimensions) - std::ldexp(single.value(), 1 - dimensions) / n + pairs.value() / (n * n);
    return std::sqrt(std::max(squared, 0.0));
}

} // namespace montelux
