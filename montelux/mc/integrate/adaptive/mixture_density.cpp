#include "montelux/mc/integrate/adaptive/mixture_density.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "montelux/mc/integrate/adaptive/boundary_density.h"
#include "montelux/mc/integrate/lane_sum.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// Too few points near a corner show how heavy its weights are, so this share is not fitted.
constexpr int boundary_units = 1;
constexpr double most_weight = 10;         // times the mean, of a point that shares are fitted to
constexpr std::size_t block_points = 1024; // whose densities stay in the cache

} // namespace

MixtureDensity::MixtureDensity(int dimensions, std::vector<MonotoneMap> maps, std::vector<Gaussian> gaussians,
                               bool boundary)
    : dimensions_(dimensions), boundary_(boundary), maps_(std::move(maps)), gaussians_(std::move(gaussians)) {
    const std::size_t n = static_cast<std::size_t>(first_gaussian()) + gaussians_.size();
    shares_.assign(n, units / static_cast<int>(n));
    shares_[0] += units - std::accumulate(shares_.begin(), shares_.end(), 0);
}

std::uint64_t MixtureDensity::balanced_points() const {
    int common = units;
    for (int share : shares_) common = std::gcd(common, share);
    return static_cast<std::uint64_t>(units / common);
}

void MixtureDensity::draw(int channel, const PointBatch& u, PointBuffer& x, std::span<double> density) const {
    x.resize(u.count(), dimensions_);
    if (channel >= first_gaussian()) return gaussian(channel).sample(u, x);
    for (int d = 0; d < dimensions_; ++d) {
        if (channel == 0)
            std::copy_n(u.coordinate(d).data(), u.count(), x.coordinate(d).data());
        else if (channel < map_channel())
            sample_boundary(u.coordinate(d), x.coordinate(d), density);
        else
            maps_[static_cast<std::size_t>(d)].sample(u.coordinate(d), x.coordinate(d), density);
    }
}

void MixtureDensity::place(int channel, const PointBatch& u, PointBuffer& x) const {
    std::vector<double> ignored(u.count(), 1.0);
    draw(channel, u, x, ignored);
}

void MixtureDensity::sample(int channel, const PointBatch& u, PointBuffer& x, std::vector<double>& density,
                            std::vector<std::size_t>* inside) const {
    const std::size_t count = u.count();
    if (channel < first_gaussian()) {
        if (inside != nullptr) {
            inside->resize(count);
            std::iota(inside->begin(), inside->end(), std::size_t{0});
        }
        density.assign(count, 1.0);
        draw(channel, u, x, density);
        if (channels() == 1) return;
        const double own = share(channel);
        for (double& p : density) p *= own;
        add_pdf(x, density, channel);
        return;
    }
    PointBuffer all;
    draw(channel, u, all, {});
    std::vector<std::size_t> own;
    std::vector<std::size_t>& in_cube = inside != nullptr ? *inside : own;
    in_cube.clear();
    for (std::size_t i = 0; i < count; ++i) {
        bool in = true;
        for (int d = 0; d < dimensions_; ++d) in = in && all(i, d) > 0 && all(i, d) < 1;
        if (in) in_cube.push_back(i);
    }
    x.resize(in_cube.size(), dimensions_);
    for (int d = 0; d < dimensions_; ++d)
        for (std::size_t j = 0; j < in_cube.size(); ++j) x(j, d) = all(in_cube[j], d);
    density.assign(in_cube.size(), 0.0);
    add_pdf(x, density, -1);
}

void MixtureDensity::channel_pdf(int channel, const PointBatch& x, std::span<double> density) const {
    if (channel >= first_gaussian()) {
        gaussian(channel).pdf(x, density);
        return;
    }
    std::fill_n(density.begin(), x.count(), 1.0);
    if (channel == 0) return;
    for (int d = 0; d < dimensions_; ++d)
        if (channel < map_channel())
            multiply_boundary_pdf(x.coordinate(d), density);
        else
            maps_[static_cast<std::size_t>(d)].multiply_pdf(x.coordinate(d), density);
}

void MixtureDensity::add_pdf(const PointBatch& x, std::span<double> density, int except) const {
    std::vector<double> part(x.count());
    for (int k = 0; k < channels(); ++k) {
        if (k == except || shares_[static_cast<std::size_t>(k)] == 0) continue;
        const double a = share(k);
        if (k == 0) {
            for (std::size_t i = 0; i < x.count(); ++i) density[i] += a;
            continue;
        }
        channel_pdf(k, x, part);
        for (std::size_t i = 0; i < x.count(); ++i) density[i] += a * part[i];
    }
}

void MixtureDensity::pdf(const PointBatch& x, std::span<double> density) const {
    std::fill_n(density.begin(), x.count(), 0.0);
    add_pdf(x, density, -1);
}

void MixtureDensity::optimise_shares(const PointBatch& x, std::span<const double> h,
                                     std::span<const double> p, int uniform_units, int step, int newest,
                                     const std::function<bool()>& stop) {
    const auto n = static_cast<std::size_t>(channels());
    if (n == 1) return;
    std::vector<std::vector<double>> q(n, std::vector<double>(x.count()));
    for (std::size_t k = 0; k < n; ++k) {
        if (stop && stop()) return;
        channel_pdf(static_cast<int>(k), x, q[k]);
    }
    const double least = static_cast<double>(uniform_units) / units;
    // A single point of far larger weight must not decide the shares.
    double total = 0;
    for (std::size_t i = 0; i < x.count(); ++i) total += h[i] / p[i];
    const double mean = total / static_cast<double>(x.count()), largest = most_weight * mean;
    std::vector<double> a(n, 1 / static_cast<double>(n)), moment(n), mixture(block_points),
        scale(block_points);
    auto normalise = [&] {
        const double sum = std::accumulate(a.begin(), a.end(), 0.0);
        for (double& v : a) v /= sum;
    };
    for (int iteration = 0; iteration < 40 && !(stop && stop()); ++iteration) {
        std::ranges::fill(moment, 0.0);
        for (std::size_t first = 0; first < x.count(); first += block_points) {
            const std::size_t count = std::min(block_points, x.count() - first);
            std::ranges::fill(mixture, 0.0);
            for (std::size_t k = 0; k < n; ++k) {
                const double *qk = &q[k][first], ak = a[k];
                for (std::size_t i = 0; i < count; ++i) mixture[i] += ak * qk[i];
            }
            for (std::size_t i = 0; i < count; ++i) {
                const double hi = h[first + i];
                const double weight = std::min(hi / p[first + i], largest), ratio = hi / mixture[i];
                scale[i] = hi > 0 && ratio < beyond_reach * mean ? weight * ratio / mixture[i] : 0;
            }
            for (std::size_t k = 0; k < n; ++k) {
                const double* qk = &q[k][first];
                moment[k] += lane_sum(count, [&](std::size_t i) { return scale[i] * qk[i]; });
            }
        }
        for (std::size_t k = 0; k < n; ++k) a[k] *= std::sqrt(moment[k]);
        if (!(std::isfinite(std::accumulate(a.begin(), a.end(), 0.0)) &&
              std::accumulate(a.begin(), a.end(), 0.0) > 0))
            return;
        normalise();
        a[0] = std::max(a[0], least);
        if (boundary_) a[1] = std::max(a[1], static_cast<double>(boundary_units) / units);
        normalise();
    }
    int left = units;
    for (std::size_t k = 0; k < n; ++k) {
        shares_[k] = static_cast<int>(std::lround(a[k] * units / step)) * step;
        if (k == 0) shares_[k] = std::max(shares_[k], (uniform_units + step - 1) / step * step);
        if (k == 1 && boundary_) shares_[k] = std::max(shares_[k], (boundary_units + step - 1) / step * step);
        if (k + static_cast<std::size_t>(newest) >= n) shares_[k] = std::max(shares_[k], step);
        left -= shares_[k];
    }
    // Step by step: no share falls below zero, and that of the uniform channel stays while another one can give.
    for (; left != 0; left -= left > 0 ? step : -step) {
        auto giver =
            std::max_element(shares_.begin() + std::min(map_channel(), channels() - 1), shares_.end());
        if (left < 0 && *giver < step) giver = std::ranges::max_element(shares_);
        *giver += left > 0 ? step : -step;
    }
}

MixtureDensity MixtureDensity::widened(double factor) const {
    MixtureDensity wide = *this;
    for (Gaussian& g : wide.gaussians_) g = g.widened(factor);
    return wide;
}

void MixtureDensity::drop_idle() {
    const auto first = static_cast<std::size_t>(first_gaussian());
    for (std::size_t k = gaussians_.size(); k-- > 0;) {
        if (shares_[first + k] > 0) continue;
        shares_.erase(shares_.begin() + static_cast<std::ptrdiff_t>(first + k));
        gaussians_.erase(gaussians_.begin() + static_cast<std::ptrdiff_t>(k));
    }
}

void MixtureDensity::save(StateWriter& state) const {
    state.put(boundary_ ? 1 : 0);
    state.put(static_cast<std::uint64_t>(maps_.size()));
    for (const MonotoneMap& map : maps_) map.save(state);
    state.put(static_cast<std::uint64_t>(gaussians_.size()));
    for (const Gaussian& g : gaussians_) g.save(state);
    state.put_all(shares_);
}

MixtureDensity MixtureDensity::load(StateReader& state, int dimensions) {
    const bool boundary = state.get<int>() != 0;
    std::vector<MonotoneMap> maps;
    for (std::uint64_t n = state.get_word(); n > 0; --n) maps.push_back(MonotoneMap::load(state));
    std::vector<Gaussian> gaussians;
    for (std::uint64_t n = state.get_word(); n > 0; --n) gaussians.push_back(Gaussian::load(state));
    MixtureDensity density(dimensions, std::move(maps), std::move(gaussians), boundary);
    std::vector<int> shares = state.get_all<int>();
    const bool fits = shares.size() == density.shares_.size() &&
                      std::ranges::all_of(shares, [](int s) { return s >= 0 && s <= units; }) &&
                      std::accumulate(shares.begin(), shares.end(), 0) == units && shares[0] > 0 &&
                      (density.maps_.empty() || static_cast<int>(density.maps_.size()) == dimensions) &&
                      std::ranges::all_of(density.gaussians_, [dimensions](const Gaussian& g) {
                          return g.dimensions() == dimensions && std::isfinite(g.log_norm());
                      });
    if (!fits) throw Error("the saved density does not fit the problem");
    density.shares_ = std::move(shares);
    return density;
}

} // namespace montelux
