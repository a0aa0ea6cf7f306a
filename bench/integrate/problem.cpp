#include "bench/integrate/problem.h"

#include <cmath>
#include <utility>

namespace montelux::bench {

void BenchProblem::set_ranges(std::vector<Range> ranges) {
    unit_cube_ = Domain(ranges).is_unit_cube();
    ranges_ = std::move(ranges);
}

void BenchProblem::evaluate(const double* const* x, std::size_t n, double* values) const {
    std::vector<double> point(ranges_.size());
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < point.size(); ++j) point[j] = x[j][i];
        values[i] = (*this)(point.data());
    }
}

double BenchProblem::on_unit_cube(const double* u) const {
    double value;
    rows_on_unit_cube(u, 1, &value);
    return value;
}

void BenchProblem::rows_on_unit_cube(const double* u, std::size_t n, double* values) const {
    const std::size_t d = ranges_.size();
    if (unit_cube_) {
        for (std::size_t i = 0; i < n; ++i) values[i] = (*this)(u + i * d);
    } else {
        PointBuffer points(n, dimensions()), mapped(n, dimensions());
        for (std::size_t i = 0; i < n; ++i)
            for (int j = 0; j < dimensions(); ++j) points(i, j) = u[i * d + static_cast<std::size_t>(j)];
        std::vector<double> volume(n, 1.0);
        Domain(ranges_).map(points, mapped, volume);
        std::vector<const double*> columns;
        for (int j = 0; j < dimensions(); ++j) columns.push_back(mapped.coordinate(j).data());
        evaluate(columns.data(), n, values);
        for (std::size_t i = 0; i < n; ++i) values[i] *= volume[i];
    }
    for (std::size_t i = 0; i < n; ++i)
        if (!std::isfinite(values[i])) values[i] = 0;
}

} // namespace montelux::bench
