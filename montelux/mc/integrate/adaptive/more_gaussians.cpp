#include "montelux/mc/integrate/adaptive/more_gaussians.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace montelux {

std::vector<Gaussian> split_gaussians(const std::vector<Gaussian>& components) {
    std::vector<Gaussian> result;
    const int parts = components.size() <= 2 ? 4 : 2;
    for (const Gaussian& g : components) {
        const int n = g.dimensions();
        const auto size = static_cast<std::size_t>(n);
        std::vector<double> covariance(size * size, 0.0);
        for (std::size_t i = 0; i < size; ++i)
            for (std::size_t j = 0; j < size; ++j)
                for (std::size_t k = 0; k <= std::min(i, j); ++k)
                    covariance[i * size + j] += g.cholesky()[i * size + k] * g.cholesky()[j * size + k];
        const Eigensystem axes = symmetric_eigensystem(covariance, n);
        const auto longest = static_cast<std::size_t>(
            std::max_element(axes.values.begin(), axes.values.end()) - axes.values.begin());
        const double variance = axes.values[longest], kept = 2.0 / (parts * parts);
        std::vector<double> narrower = covariance;
        for (std::size_t i = 0; i < size; ++i)
            for (std::size_t j = 0; j < size; ++j)
                narrower[i * size + j] -= 0.8 * (1 - kept) * variance * axes.vectors[i * size + longest] *
                                          axes.vectors[j * size + longest];
        const std::vector<double> factor = cholesky_factor(narrower, n);
        if (factor.empty()) {
            result.push_back(g);
            continue;
        }
        for (int p = 0; p < parts; ++p) {
            const double offset = 1.5 * std::sqrt(variance) * ((2 * p + 1.0) / parts - 1);
            std::vector<double> mean(g.mean().begin(), g.mean().end());
            for (std::size_t i = 0; i < size; ++i) mean[i] += offset * axes.vectors[i * size + longest];
            result.emplace_back(std::move(mean), factor);
        }
    }
    return result;
}

std::vector<Gaussian> scattered_gaussians(const PointBatch& x, std::span<const double> weights) {
    const auto n = static_cast<std::size_t>(x.dimensions());
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    if (!(total > 0 && std::isfinite(total))) return {};
    std::vector<double> factor(n * n, 0.0);
    for (std::size_t d = 0; d < n; ++d) {
        std::span<const double> coordinate = x.coordinate(static_cast<int>(d));
        double mean = 0, variance = 0;
        for (std::size_t i = 0; i < weights.size(); ++i) mean += weights[i] / total * coordinate[i];
        for (std::size_t i = 0; i < weights.size(); ++i)
            variance += weights[i] / total * std::pow(coordinate[i] - mean, 2);
        factor[d * n + d] = std::sqrt(0.5 * std::max(variance, 1e-12));
    }
    std::vector<Gaussian> gaussians;
    double sum = 0;
    constexpr int count = 4;
    std::size_t i = 0;
    for (int k = 0; k < count; ++k) {
        for (; i + 1 < weights.size() && sum + weights[i] <= (k + 0.5) / count * total; ++i)
            sum += weights[i];
        std::vector<double> mean(n);
        x.gather(i, mean.data());
        gaussians.emplace_back(std::move(mean), factor);
    }
    return gaussians;
}

} // namespace montelux
