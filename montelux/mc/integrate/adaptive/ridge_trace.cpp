#include "montelux/mc/integrate/adaptive/ridge_trace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "montelux/mc/integrate/adaptive/gaussian.h"
#include "montelux/mc/math/special.h"
#include "montelux/mc/random/philox_stream.h"

namespace montelux {
namespace {

using Vector = std::vector<double>;

constexpr std::size_t cloud_points = 512, neighbours = 24;
constexpr int most_steps = 64, most_failures = 12;
// Points of a step: distances from the axis, as parts of the step, each to both sides of a random direction.
constexpr std::array around{0.5, 0.25, 0.125, 0.06, 0.03};
constexpr double shorter = 0.4, longer = 1.5;
constexpr double fallen = 2, steady = 0.5; // fall of log h over a step: too long, or short
constexpr double negligible = 1e-7;        // part of the largest value
constexpr double bend = 0.5;               // of the last change of direction, expected again

void normalise(Vector& v) {
    const double length = std::sqrt(std::inner_product(v.begin(), v.end(), v.begin(), 0.0));
    if (length > 0)
        for (double& c : v) c /= length;
}

class Trace {
  public:
    Trace(const DensityFunction& h, std::size_t n, double largest, std::uint64_t key, std::uint64_t budget)
        : h_(h), n_(n), largest_(largest), numbers_(key), budget_(budget) {}

    void follow(Vector at, double height, Vector direction, double step) {
        Vector before = direction;
        for (int i = 0, failures = 0; i < most_steps && failures < most_failures; ++i) {
            const std::size_t count = 1 + 2 * around.size();
            if (budget_ < count) return;
            budget_ -= count;
            const auto [best, value] = best_around(at, direction, step);
            if (!(value > height * std::exp(-fallen))) {
                step *= shorter;
                ++failures;
                continue;
            }
            Vector moved(n_);
            for (std::size_t d = 0; d < n_; ++d) moved[d] = best[d] - at[d];
            normalise(moved);
            for (std::size_t d = 0; d < n_; ++d) direction[d] = moved[d] + bend * (moved[d] - before[d]);
            normalise(direction);
            before = moved;
            if (value > height * std::exp(-steady)) step *= longer;
            at = best;
            height = value;
            if (height < negligible * largest_) return;
            points_.push_back(best);
            heights_.push_back(value);
        }
    }

    TracedPoints points() && {
        TracedPoints traced{PointBuffer(points_.size(), static_cast<int>(n_)), std::move(heights_)};
        for (std::size_t i = 0; i < points_.size(); ++i)
            for (std::size_t d = 0; d < n_; ++d) traced.x(i, static_cast<int>(d)) = points_[i][d];
        return traced;
    }

  private:
    std::pair<Vector, double> best_around(const Vector& at, const Vector& direction, double step) {
        PointBuffer tries(1 + 2 * around.size(), static_cast<int>(n_));
        Vector ahead(n_), across(n_);
        for (std::size_t d = 0; d < n_; ++d) ahead[d] = at[d] + step * direction[d];
        for (std::size_t k = 0; k < around.size(); ++k) {
            for (double& c : across) c = normal_quantile(numbers_.next_double());
            const double along = std::inner_product(across.begin(), across.end(), direction.begin(), 0.0);
            for (std::size_t d = 0; d < n_; ++d) across[d] -= along * direction[d];
            normalise(across);
            for (std::size_t d = 0; d < n_; ++d) {
                tries(2 * k, static_cast<int>(d)) = ahead[d] + around[k] * step * across[d];
                tries(2 * k + 1, static_cast<int>(d)) = ahead[d] - around[k] * step * across[d];
            }
        }
        for (std::size_t d = 0; d < n_; ++d) tries(2 * around.size(), static_cast<int>(d)) = ahead[d];
        std::vector<char> inside(tries.count(), 1);
        for (std::size_t i = 0; i < tries.count(); ++i)
            for (std::size_t d = 0; d < n_; ++d) {
                double& c = tries(i, static_cast<int>(d));
                inside[i] = inside[i] && c > 0 && c < 1;
                c = std::clamp(c, 1e-12, 1 - 1e-12);
            }
        Vector values(tries.count());
        h_(tries, values);
        std::size_t best = tries.count();
        double most = 0;
        for (std::size_t i = 0; i < tries.count(); ++i)
            if (inside[i] && values[i] > most) most = values[i], best = i;
        Vector top(n_);
        if (best < tries.count()) tries.view().gather(best, top.data());
        return {std::move(top), most};
    }

    const DensityFunction& h_;
    std::size_t n_;
    double largest_;
    PhiloxStream numbers_;
    std::uint64_t budget_;
    std::vector<Vector> points_;
    Vector heights_;
};

// Points drawn by weight: as many of them lie in a part as it holds of the integral.
std::vector<std::size_t> cloud(std::span<const double> weights) {
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    std::vector<std::size_t> drawn;
    double sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        sum += weights[i];
        // Once at most: points that are equal tell no direction.
        if (sum / total * cloud_points < static_cast<double>(drawn.size()) + 0.5) continue;
        drawn.push_back(i);
    }
    return drawn;
}

} // namespace

TracedPoints trace_ridge(const DensityFunction& h, const PointBatch& x, std::span<const double> h_at_x,
                         std::span<const double> ratios, std::uint64_t key, std::uint64_t max_evaluations) {
    const auto n = static_cast<std::size_t>(x.dimensions());
    Trace trace(h, n, *std::ranges::max_element(h_at_x), key, max_evaluations);
    const auto distance = [&](std::size_t a, std::size_t b) {
        double squares = 0;
        for (int d = 0; d < x.dimensions(); ++d) squares += std::pow(x(a, d) - x(b, d), 2);
        return squares;
    };
    std::vector<std::size_t> near = cloud(ratios);
    if (near.size() < neighbours) return std::move(trace).points();
    const auto first = static_cast<std::size_t>(std::ranges::max_element(ratios) - ratios.begin());
    std::size_t second = first;
    double most = 0;
    for (std::size_t i = 0; i < ratios.size(); ++i)
        if (const double size = ratios[i] * distance(i, first); size > most) most = size, second = i;
    for (std::size_t start : {first, second}) {
        std::ranges::partial_sort(near, near.begin() + neighbours, {},
                                  [&](std::size_t i) { return distance(i, start); });
        Vector mean(n, 0.0), covariance(n * n, 0.0), at(n);
        for (std::size_t k = 0; k < neighbours; ++k)
            for (std::size_t d = 0; d < n; ++d) mean[d] += x(near[k], static_cast<int>(d)) / neighbours;
        for (std::size_t k = 0; k < neighbours; ++k)
            for (std::size_t a = 0; a < n; ++a)
                for (std::size_t b = 0; b < n; ++b)
                    covariance[a * n + b] += (x(near[k], static_cast<int>(a)) - mean[a]) *
                                             (x(near[k], static_cast<int>(b)) - mean[b]) / neighbours;
        const Eigensystem axes = symmetric_eigensystem(covariance, static_cast<int>(n));
        const auto longest =
            static_cast<std::size_t>(std::ranges::max_element(axes.values) - axes.values.begin());
        x.gather(start, at.data());
        for (double side : {1.0, -1.0}) {
            Vector axis(n);
            for (std::size_t d = 0; d < n; ++d) axis[d] = side * axes.vectors[d * n + longest];
            trace.follow(at, h_at_x[start], std::move(axis), std::sqrt(std::max(axes.values[longest], 0.0)));
        }
    }
    return std::move(trace).points();
}

} // namespace montelux
