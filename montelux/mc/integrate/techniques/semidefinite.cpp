#include "montelux/mc/integrate/techniques/semidefinite.h"

#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace montelux {

std::vector<double> solve_semidefinite(std::span<const double> matrix, std::span<const double> right,
                                       int columns, double tolerance) {
    const std::size_t n = columns > 0 ? right.size() / static_cast<std::size_t>(columns) : 0;
    std::vector<double> x(right.size(), 0.0);
    // The decomposition of the matrix scaled to a unit diagonal, so that units of unknowns do not matter.
    std::vector<double> scale(n);
    for (std::size_t i = 0; i < n; ++i) {
        const double diagonal = matrix[i * n + i];
        scale[i] = diagonal > 0 && std::isfinite(diagonal) ? 1 / std::sqrt(diagonal) : 0;
    }
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    auto scaled = [&](std::size_t i, std::size_t j) {
        return (i > j ? matrix[i * n + j] : matrix[j * n + i]) * scale[i] * scale[j];
    };
    std::vector<double> l(n * n); // rows in the order of pivots
    std::vector<double> pivot(n);
    for (std::size_t i = 0; i < n; ++i) pivot[i] = scale[i] > 0 ? 1 : 0;
    std::size_t rank = 0;
    for (; rank < n; ++rank) {
        std::size_t best = rank;
        for (std::size_t i = rank + 1; i < n; ++i)
            if (pivot[order[i]] > pivot[order[best]]) best = i;
        if (!(pivot[order[best]] > tolerance)) break;
        std::swap(order[rank], order[best]);
        for (std::size_t j = 0; j < rank; ++j) std::swap(l[rank * n + j], l[best * n + j]);
        const double root = std::sqrt(pivot[order[rank]]);
        l[rank * n + rank] = root;
        for (std::size_t i = rank + 1; i < n; ++i) {
            double sum = scaled(order[i], order[rank]);
            for (std::size_t j = 0; j < rank; ++j) sum -= l[i * n + j] * l[rank * n + j];
            l[i * n + rank] = sum / root;
            pivot[order[i]] -= l[i * n + rank] * l[i * n + rank];
        }
    }
    std::vector<double> y(rank);
    for (std::size_t c = 0; c < static_cast<std::size_t>(columns); ++c) {
        for (std::size_t i = 0; i < rank; ++i) {
            double sum = right[c * n + order[i]] * scale[order[i]];
            for (std::size_t j = 0; j < i; ++j) sum -= l[i * n + j] * y[j];
            y[i] = sum / l[i * n + i];
        }
        for (std::size_t i = rank; i-- > 0;) {
            double sum = y[i];
            for (std::size_t j = i + 1; j < rank; ++j) sum -= l[j * n + i] * y[j];
            y[i] = sum / l[i * n + i];
        }
        for (std::size_t i = 0; i < rank; ++i) x[c * n + order[i]] = y[i] * scale[order[i]];
    }
    return x;
}

} // namespace montelux
