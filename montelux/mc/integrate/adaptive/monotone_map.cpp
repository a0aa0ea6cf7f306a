#include "montelux/mc/integrate/adaptive/monotone_map.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// Open at both ends, so that no coordinate is mapped to infinity.
constexpr double smallest_u = 0x1p-53, largest_u = 1 - 0x1p-53;
constexpr double least_position = 1e-290;
constexpr double end_ratio = 4; // slopes are extrapolated to the ends within this factor

} // namespace

MonotoneMap::MonotoneMap(std::vector<double> edges, std::vector<double> masses, double power)
    : power_(power), edges_(std::move(edges)), masses_(std::move(masses)) {
    const std::size_t n = masses_.size();
    if (!(power > 0 && power <= 1)) throw Error("MonotoneMap", "expected a power in (0, 1]");
    if (n == 0 || edges_.size() != n + 1 || edges_.front() != 0 || edges_.back() != 1)
        throw Error("MonotoneMap", "expected bins from 0 to 1, with one mass each");
    for (std::size_t k = 0; k < n; ++k)
        if (!(edges_[k] < edges_[k + 1] && masses_[k] > 0 && std::isfinite(masses_[k])))
            throw Error("MonotoneMap", "expected increasing edges and finite masses above zero");
    const double total = std::accumulate(masses_.begin(), masses_.end(), 0.0);
    double u = 0;
    for (std::size_t k = 0; k < n; ++k) {
        // The masses stay as given, so that a map that was saved has the same bits when it is loaded.
        const double end = k + 1 == n ? 1 : u + masses_[k] / total;
        bins_.push_back({u, end - u, edges_[k], edges_[k + 1] - edges_[k], 0, 0});
        u_starts_.push_back(u);
        x_starts_.push_back(edges_[k]);
        u = end;
    }
    auto mean_slope = [](const Bin& b) { return b.dx / b.du; };
    auto joined = [&](std::size_t k) { // bins k - 1 and k
        const double ratio = mean_slope(bins_[k]) / mean_slope(bins_[k - 1]);
        return ratio <= MonotoneMap::jump_ratio && ratio >= 1 / MonotoneMap::jump_ratio;
    };
    // At an inner edge the logarithm of the slope is interpolated between the bins' middles.
    for (std::size_t k = 1; k < n; ++k)
        if (joined(k)) {
            const Bin &a = bins_[k - 1], &b = bins_[k];
            const double share = a.du / (a.du + b.du);
            const double slope = std::pow(mean_slope(a), 1 - share) * std::pow(mean_slope(b), share);
            bins_[k - 1].slope1 = bins_[k].slope0 = slope;
        }
    // Ends that join nothing follow the trend of their bin.
    for (Bin& b : bins_) {
        const double mean = mean_slope(b);
        auto mirrored = [&](double other) {
            return other > 0 ? std::clamp(mean * mean / other, mean / end_ratio, mean * end_ratio) : mean;
        };
        const double slope0 = b.slope0, slope1 = b.slope1;
        if (!(slope0 > 0)) b.slope0 = mirrored(slope1);
        if (!(slope1 > 0)) b.slope1 = mirrored(slope0);
    }
}

const MonotoneMap::Bin& MonotoneMap::bin_of(const std::vector<double>& starts, double at) const {
    // Bisection without branches that depend on data.
    std::size_t first = 0, count = starts.size();
    while (count > 1) {
        const std::size_t half = count / 2;
        first += starts[first + half] <= at ? half : 0;
        count -= half;
    }
    return bins_[first];
}

double MonotoneMap::quantile(double u, double& density) const {
    const Bin& b = bin_of(u_starts_, u);
    if (power_ < 1 && &b == bins_.data()) {
        const double y = std::max(std::pow(u / b.du, 1 / power_), least_position / b.dx);
        density = b.du / b.dx * power_ * std::pow(y, power_ - 1);
        return b.dx * std::min(y, 1.0);
    }
    const double slope = b.dx / b.du, t = std::clamp((u - b.u0) / b.du, 0.0, 1.0), s = 1 - t;
    const double denominator = slope + (b.slope0 + b.slope1 - 2 * slope) * t * s;
    const double x = b.x0 + b.dx * t * (slope * t + b.slope0 * s) / denominator;
    density = denominator * denominator /
              (slope * slope * (b.slope1 * t * t + 2 * slope * t * s + b.slope0 * s * s));
    return std::clamp(x, smallest_u, largest_u);
}

double MonotoneMap::quantile(double u) const {
    double density;
    return quantile(u, density);
}

double MonotoneMap::pdf(double x) const {
    const Bin& b = bin_of(x_starts_, x);
    if (power_ < 1 && &b == bins_.data())
        return b.du / b.dx * power_ * std::pow(std::max(x, least_position) / b.dx, power_ - 1);
    const double slope = b.dx / b.du, y = std::clamp((x - b.x0) / b.dx, 0.0, 1.0);
    const double bend = b.slope0 + b.slope1 - 2 * slope;
    // t solves a t^2 + b t + c = 0, with the root in [0, 1] in the form that does not cancel.
    const double qa = slope - b.slope0 + y * bend, qb = b.slope0 - y * bend, qc = -slope * y;
    const double root = std::sqrt(std::max(0.0, qb * qb - 4 * qa * qc));
    const double t = std::clamp(-2 * qc / (qb + root), 0.0, 1.0), s = 1 - t;
    const double denominator = slope + bend * t * s;
    return denominator * denominator /
           (slope * slope * (b.slope1 * t * t + 2 * slope * t * s + b.slope0 * s * s));
}

void MonotoneMap::sample(std::span<const double> u, std::span<double> x, std::span<double> density) const {
    for (std::size_t i = 0; i < u.size(); ++i) {
        double p;
        x[i] = quantile(u[i], p);
        density[i] *= p;
    }
}

void MonotoneMap::multiply_pdf(std::span<const double> x, std::span<double> density) const {
    for (std::size_t i = 0; i < x.size(); ++i) density[i] *= pdf(x[i]);
}

void MonotoneMap::save(StateWriter& state) const {
    state.put(edges_);
    state.put(masses_);
    state.put(power_);
}

MonotoneMap MonotoneMap::load(StateReader& state) {
    std::vector<double> edges = state.get_doubles();
    std::vector<double> masses = state.get_doubles();
    return {std::move(edges), std::move(masses), state.get_double()};
}

} // namespace montelux
