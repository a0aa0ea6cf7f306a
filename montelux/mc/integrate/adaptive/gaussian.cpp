#include "montelux/mc/integrate/adaptive/gaussian.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/special.h"

namespace montelux {
namespace {

constexpr std::size_t most_points = 16384; // that a fit takes
constexpr double least_log_density = -700;

} // namespace

Gaussian::Gaussian(std::vector<double> mean, std::vector<double> cholesky)
    : mean_(std::move(mean)), cholesky_(std::move(cholesky)) {
    const std::size_t n = mean_.size();
    if (cholesky_.size() != n * n)
        throw Error("Gaussian", "expected a square factor of the size of the mean");
    inverse_.assign(n * n, 0);
    log_norm_ = -0.5 * static_cast<double>(n) * std::log(2 * pi);
    for (std::size_t i = 0; i < n; ++i) {
        if (!(cholesky_[i * n + i] > 0))
            throw Error("Gaussian", "expected a factor with a diagonal above zero");
        log_norm_ -= std::log(cholesky_[i * n + i]);
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = i == j ? 1 : 0;
            for (std::size_t k = j; k < i; ++k) sum -= cholesky_[i * n + k] * inverse_[k * n + j];
            inverse_[i * n + j] = sum / cholesky_[i * n + i];
        }
    }
}

void Gaussian::sample(const PointBatch& u, PointBuffer& x) const {
    const std::size_t n = mean_.size();
    std::vector<double> z(n);
    for (std::size_t i = 0; i < u.count(); ++i) {
        for (std::size_t d = 0; d < n; ++d) z[d] = normal_quantile(u(i, static_cast<int>(d)));
        for (std::size_t d = 0; d < n; ++d) {
            double v = mean_[d];
            for (std::size_t k = 0; k <= d; ++k) v += cholesky_[d * n + k] * z[k];
            x(i, static_cast<int>(d)) = v;
        }
    }
}

void Gaussian::log_pdf(const PointBatch& x, std::span<double> result) const {
    const std::size_t n = mean_.size(), count = x.count();
    std::fill_n(result.begin(), count, log_norm_);
    std::vector<double> z(count);
    for (std::size_t i = 0; i < n; ++i) {
        std::fill(z.begin(), z.end(), 0.0);
        for (std::size_t j = 0; j <= i; ++j) {
            const double factor = inverse_[i * n + j], mean = mean_[j];
            const double* coordinate = x.coordinate(static_cast<int>(j)).data();
            for (std::size_t p = 0; p < count; ++p) z[p] += factor * (coordinate[p] - mean);
        }
        for (std::size_t p = 0; p < count; ++p) result[p] -= 0.5 * z[p] * z[p];
    }
}

void Gaussian::pdf(const PointBatch& x, std::span<double> result) const {
    log_pdf(x, result);
    for (std::size_t p = 0; p < x.count(); ++p)
        result[p] = result[p] > least_log_density ? std::exp(result[p]) : 0;
}

double Gaussian::squared_distance(std::span<const double> x) const {
    const std::size_t n = mean_.size();
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
        double z = 0;
        for (std::size_t j = 0; j <= i; ++j) z += inverse_[i * n + j] * (x[j] - mean_[j]);
        sum += z * z;
    }
    return sum;
}

Gaussian Gaussian::widened(double factor) const {
    std::vector<double> wide = cholesky_;
    for (double& v : wide) v *= factor;
    return {mean_, std::move(wide)};
}

void Gaussian::save(StateWriter& state) const {
    state.put(mean_);
    state.put(cholesky_);
}

Gaussian Gaussian::load(StateReader& state) {
    std::vector<double> mean = state.get_doubles();
    return {std::move(mean), state.get_doubles()};
}

std::vector<double> cholesky_factor(std::span<const double> matrix, int n) {
    const auto size = static_cast<std::size_t>(n);
    std::vector<double> l(size * size, 0);
    for (std::size_t i = 0; i < size; ++i)
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = matrix[i * size + j];
            for (std::size_t k = 0; k < j; ++k) sum -= l[i * size + k] * l[j * size + k];
            if (i == j) {
                if (!(sum > 1e-14)) return {};
                l[i * size + i] = std::sqrt(sum);
            } else {
                l[i * size + j] = sum / l[j * size + j];
            }
        }
    return l;
}

Eigensystem symmetric_eigensystem(std::vector<double> a, int n) {
    const auto size = static_cast<std::size_t>(n);
    std::vector<double> v(size * size, 0);
    for (std::size_t i = 0; i < size; ++i) v[i * size + i] = 1;
    for (int sweep = 0; sweep < 60; ++sweep) {
        double off = 0, diagonal = 0;
        for (std::size_t p = 0; p < size; ++p) {
            diagonal += a[p * size + p] * a[p * size + p];
            for (std::size_t q = p + 1; q < size; ++q) off += a[p * size + q] * a[p * size + q];
        }
        if (!(off > 1e-24 * diagonal)) break;
        for (std::size_t p = 0; p < size; ++p)
            for (std::size_t q = p + 1; q < size; ++q) {
                if (a[p * size + q] == 0) continue;
                const double theta = (a[q * size + q] - a[p * size + p]) / (2 * a[p * size + q]);
                const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::hypot(theta, 1.0));
                const double c = 1 / std::hypot(t, 1.0), s = t * c;
                auto rotate = [&](double& x, double& y) {
                    const double old = x;
                    x = c * old - s * y;
                    y = s * old + c * y;
                };
                for (std::size_t k = 0; k < size; ++k) rotate(a[k * size + p], a[k * size + q]);
                for (std::size_t k = 0; k < size; ++k) rotate(a[p * size + k], a[q * size + k]);
                for (std::size_t k = 0; k < size; ++k) rotate(v[k * size + p], v[k * size + q]);
            }
    }
    Eigensystem result{std::vector<double>(size), std::move(v)};
    for (std::size_t i = 0; i < size; ++i) result.values[i] = a[i * size + i];
    return result;
}

bool fit_gaussians(std::vector<Gaussian>& components, const PointBatch& x, std::span<const double> weights,
                   int steps, const std::function<bool()>& stop) {
    if (components.empty()) return true;
    const auto n = static_cast<std::size_t>(x.dimensions());
    double total = 0;
    for (double w : weights) total += w;
    // Points with non-zero weight, contiguous.
    std::vector<std::size_t> used;
    for (std::size_t i = 0; i < x.count(); ++i)
        if (weights[i] * static_cast<double>(x.count()) > 1e-9 * total) used.push_back(i);
    // A systematic subsample drawn by weight, whose points then have equal weights.
    std::vector<double> resampled;
    if (used.size() > most_points) {
        double sum = 0;
        for (std::size_t i : used) sum += weights[i];
        std::vector<std::size_t> drawn;
        resampled.assign(weights.size(), 0.0);
        double below = 0, next = 0.5;
        for (std::size_t i : used) {
            below += weights[i] / sum * static_cast<double>(most_points);
            if (!(next < below)) continue;
            const double times = std::ceil(below - next);
            resampled[i] = times;
            next += times;
            drawn.push_back(i);
        }
        used = std::move(drawn);
        weights = resampled;
        total = static_cast<double>(most_points);
    }
    PointBuffer points(used.size(), x.dimensions());
    for (int d = 0; d < x.dimensions(); ++d)
        for (std::size_t j = 0; j < used.size(); ++j) points(j, d) = x(used[j], d);

    std::vector<double> shares(components.size(), 1.0 / static_cast<double>(components.size()));
    std::vector<std::vector<double>> part(components.size(), std::vector<double>(used.size()));
    for (int step = 0; step < steps; ++step) {
        if (stop && stop()) return false;
        for (std::size_t k = 0; k < components.size(); ++k) {
            components[k].pdf(points, part[k]);
            for (double& p : part[k]) p *= shares[k];
        }
        for (std::size_t j = 0; j < used.size(); ++j) {
            double sum = 0;
            for (const auto& p : part) sum += p[j];
            const double scale = sum > 0 ? weights[used[j]] / total / sum : 0;
            for (auto& p : part) p[j] *= scale;
        }
        for (std::size_t k = 0; k < components.size(); ++k) {
            double mass = 0, squares = 0;
            std::vector<double> mean(n, 0.0), covariance(n * n, 0.0);
            for (std::size_t j = 0; j < used.size(); ++j) {
                mass += part[k][j];
                squares += part[k][j] * part[k][j];
                for (std::size_t d = 0; d < n; ++d) mean[d] += part[k][j] * points(j, static_cast<int>(d));
            }
            shares[k] = mass;
            const double effective = squares > 0 ? mass * mass / squares : 0;
            if (mass < 1e-4 || effective < static_cast<double>(2 * n + 2)) continue;
            for (double& m : mean) m /= mass;
            std::vector<double> offset(n);
            for (std::size_t j = 0; j < used.size(); ++j) {
                const double r = part[k][j] / mass;
                if (!(r > 0)) continue;
                for (std::size_t d = 0; d < n; ++d) offset[d] = points(j, static_cast<int>(d)) - mean[d];
                for (std::size_t a = 0; a < n; ++a)
                    for (std::size_t b = 0; b <= a; ++b) covariance[a * n + b] += r * offset[a] * offset[b];
            }
            double trace = 0;
            for (std::size_t d = 0; d < n; ++d) trace += covariance[d * n + d] / static_cast<double>(n);
            for (std::size_t d = 0; d < n; ++d) covariance[d * n + d] += 1e-3 * trace;
            std::vector<double> factor = cholesky_factor(covariance, static_cast<int>(n));
            if (!factor.empty()) components[k] = Gaussian(std::move(mean), std::move(factor));
        }
    }
    for (std::size_t k = components.size(); k-- > 0;)
        if (shares[k] < 1e-4) components.erase(components.begin() + static_cast<std::ptrdiff_t>(k));
    return true;
}

} // namespace montelux
