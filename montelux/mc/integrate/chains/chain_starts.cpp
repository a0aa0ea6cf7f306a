#include "montelux/mc/integrate/chains/chain_starts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "montelux/mc/integrate/metropolis/metropolis_chain.h"
#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/philox_stream.h"

namespace montelux {
namespace {

constexpr std::size_t start_draws = 1000;
constexpr int scatter_attempts = 60;
constexpr double no_density = -std::numeric_limits<double>::infinity();

} // namespace

std::vector<double> random_starts(LogDensityCalls& density, const Domain& domain, std::size_t walkers,
                                  std::uint64_t seed, std::uint32_t chain) {
    const std::size_t d = density.dimensions();
    PointBuffer u(start_draws, static_cast<int>(d)), x(start_draws, static_cast<int>(d));
    fill_random(u, hash_key(seed, 0x7374617274), chain, 0);
    std::vector<double> volume(start_draws, 1.0), points(start_draws * d), log_p(start_draws);
    domain.map(u, x, volume);
    for (std::size_t i = 0; i < start_draws; ++i) x.view().gather(i, &points[i * d]);
    density(points, log_p);
    // In proportion to the density and without replacement: the largest log p + Gumbel numbers.
    std::vector<std::pair<double, std::size_t>> keys;
    PhiloxStream numbers(hash_key(seed, 0x67756d62656c), {chain, 0, 0});
    for (std::size_t i = 0; i < start_draws; ++i) {
        const double gumbel = -std::log(-std::log(numbers.next_double()));
        const double key = log_p[i] + std::log(volume[i]) + gumbel;
        if (log_p[i] > no_density && std::isfinite(key)) keys.emplace_back(-key, i);
    }
    if (keys.empty())
        throw Error("sample", "the density is zero at all of " + std::to_string(start_draws) +
                                  " points; expected a start (--start, starts), where it is not");
    if (keys.size() < walkers)
        throw Error("sample", "the density is above zero at only " + std::to_string(keys.size()) + " of " +
                                  std::to_string(start_draws) + " points, too few for " +
                                  std::to_string(walkers) +
                                  " walkers to start from; expected a start (--start, starts)");
    std::partial_sort(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(walkers), keys.end());
    std::vector<double> starts;
    for (std::size_t w = 0; w < walkers; ++w) {
        const auto at = points.begin() + static_cast<std::ptrdiff_t>(keys[w].second * d);
        starts.insert(starts.end(), at, at + static_cast<std::ptrdiff_t>(d));
    }
    return starts;
}

std::vector<double> scattered_starts(LogDensityCalls& density, const std::vector<double>& start,
                                     const Domain& domain, std::size_t walkers, std::uint64_t seed,
                                     std::uint32_t chain) {
    const std::size_t d = start.size();
    PhiloxStream numbers(hash_key(seed, 0x73636174746572), {chain, 0, 0});
    std::vector<double> starts = start, point(d);
    double log_p = no_density;
    density(start, {&log_p, 1});
    if (log_p == no_density)
        throw Error("sample", "the density is zero, or not a number, at the start of chain " +
                                  std::to_string(chain) + "; expected one where it is not");
    while (starts.size() < walkers * d) {
        double scale = 0.01;
        log_p = no_density;
        for (int attempt = 0; attempt < scatter_attempts && log_p == no_density; ++attempt, scale *= 0.5) {
            for (std::size_t k = 0; k < d; ++k) {
                const Range range = domain.ranges()[k];
                const double width = range.upper - range.lower;
                const double unit = std::isfinite(width) ? width : std::max(1.0, std::abs(start[k]));
                point[k] = start[k] + scale * unit * detail::draw_normals(numbers).x;
            }
            density(point, {&log_p, 1});
        }
        if (log_p == no_density)
            throw Error("sample", "the density is zero about the start of chain " + std::to_string(chain) +
                                      ", where its other walkers start; expected a start for each walker");
        starts.insert(starts.end(), point.begin(), point.end());
    }
    return starts;
}

} // namespace montelux
