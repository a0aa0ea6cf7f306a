#include "montelux/mc/integrate/adaptive/surprises.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace montelux {
namespace {

constexpr std::size_t most_neighbours = 1000;
constexpr double least_width = 1e-3; // squared, of the longest axis: neighbours may lie in a plane
constexpr double wider = 1.5;        // in variance, than the neighbourhood, which is cut off around

// Standard deviations of the weighted points, along each coordinate.
std::vector<double> widths(const PointBatch& x, std::span<const double> weights) {
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    std::vector<double> result;
    for (int d = 0; d < x.dimensions(); ++d) {
        std::span<const double> v = x.coordinate(d);
        double mean = 0, variance = 0;
        for (std::size_t i = 0; i < v.size(); ++i) mean += weights[i] / total * v[i];
        for (std::size_t i = 0; i < v.size(); ++i)
            variance += weights[i] / total * (v[i] - mean) * (v[i] - mean);
        result.push_back(std::sqrt(std::max(variance, 1e-24)));
    }
    return result;
}

// Weighted moments of some of the points; empty where they determine none.
std::vector<Gaussian> local_gaussian(const PointBatch& x, std::span<const double> weights,
                                     std::span<const std::uint32_t> points) {
    const auto n = static_cast<std::size_t>(x.dimensions());
    double total = 0;
    std::vector<double> mean(n, 0.0), covariance(n * n, 0.0), offset(n);
    for (std::uint32_t i : points) {
        total += weights[i];
        for (std::size_t d = 0; d < n; ++d) mean[d] += weights[i] * x(i, static_cast<int>(d));
    }
    if (!(total > 0 && std::isfinite(total))) return {};
    for (double& m : mean) m /= total;
    for (std::uint32_t i : points) {
        for (std::size_t d = 0; d < n; ++d) offset[d] = x(i, static_cast<int>(d)) - mean[d];
        for (std::size_t a = 0; a < n; ++a)
            for (std::size_t b = 0; b <= a; ++b)
                covariance[a * n + b] += wider * weights[i] / total * offset[a] * offset[b];
    }
    double trace = 0;
    for (std::size_t d = 0; d < n; ++d) trace += covariance[d * n + d];
    for (std::size_t d = 0; d < n; ++d) covariance[d * n + d] += least_width * trace;
    std::vector<double> factor = cholesky_factor(covariance, x.dimensions());
    if (factor.empty()) return {};
    return {Gaussian(std::move(mean), std::move(factor))};
}

} // namespace

std::vector<Gaussian> gaussians_at_surprises(const PointBatch& x, std::span<const double> weights,
                                             std::span<const double> ratios, const SurpriseSearch& settings) {
    const std::size_t count = x.count();
    std::vector<Gaussian> result;
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    if (count == 0 || !(total > 0)) return result;
    const double threshold = settings.surprising * total / static_cast<double>(count);
    const double enough = 3.0 * x.dimensions() + 3; // effective neighbours
    const std::vector<double> scale = widths(x, weights);
    std::vector<double> left(ratios.begin(), ratios.end()), distance(count);
    std::vector<std::uint32_t> order(count);
    for (int k = 0; k < settings.most; ++k) {
        const auto centre =
            static_cast<std::size_t>(std::max_element(left.begin(), left.end()) - left.begin());
        if (!(left[centre] > threshold)) break;
        std::fill(distance.begin(), distance.end(), 0.0);
        for (int d = 0; d < x.dimensions(); ++d) {
            std::span<const double> v = x.coordinate(d);
            const double inverse = 1 / scale[static_cast<std::size_t>(d)], at = v[centre];
            for (std::size_t i = 0; i < count; ++i)
                distance[i] += (v[i] - at) * inverse * ((v[i] - at) * inverse);
        }
        std::iota(order.begin(), order.end(), std::uint32_t{0});
        const std::size_t near = std::min(most_neighbours, count);
        auto closer = [&](std::uint32_t a, std::uint32_t b) {
            return distance[a] != distance[b] ? distance[a] < distance[b] : a < b;
        };
        std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(near) - 1, order.end(),
                         closer);
        std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(near), closer);
        double sum = 0, squares = 0;
        std::size_t used = 0;
        while (used < near && !(squares > 0 && sum * sum > enough * squares)) {
            const double w = weights[order[used++]];
            sum += w;
            squares += w * w;
        }
        const std::span<const std::uint32_t> neighbours(order.data(), used);
        for (std::uint32_t i : neighbours) left[i] = 0;
        for (Gaussian& g : local_gaussian(x, weights, neighbours)) result.push_back(std::move(g));
    }
    return result;
}

} // namespace montelux
