#include "montelux/mc/integrate/chains/chain_starts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "montelux/mc/integrate/metropolis/metropolis_chain.h"
#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/philox_stream.h"

namespace montelux {
namespace {

constexpr std::size_t fewest_start_draws = 1000, start_draws_per_walker = 4;
constexpr double largest_scatter = 0.01, smallest_scatter = 1e-8; // of the unit of a coordinate
constexpr int scatter_attempts = 8;                               // at each scale
constexpr double no_density = -std::numeric_limits<double>::infinity();

double reflected(double x, const Range& range) {
    if (x < range.lower) return 2 * range.lower - x;
    if (x > range.upper) return 2 * range.upper - x;
    return x;
}

// The differences of walkers from the first one of each part: exactly zero where a variable is constant.
std::vector<std::vector<double>> difference_columns(std::span<const double> starts, std::size_t d,
                                                    std::size_t parts) {
    const std::size_t walkers = starts.size() / d;
    std::vector<std::vector<double>> columns(d, std::vector<double>(walkers, 0.0));
    for (std::size_t w = 0; w < walkers; ++w) {
        const std::size_t first = parts == 1 || w < walkers / 2 ? 0 : walkers / 2;
        for (std::size_t k = 0; k < d; ++k) columns[k][w] = starts[w * d + k] - starts[first * d + k];
    }
    return columns;
}

} // namespace

std::vector<double> random_starts(LogDensityCalls& density, const Domain& domain, std::size_t walkers,
                                  std::uint64_t seed, std::uint32_t chain) {
    const std::size_t d = density.dimensions();
    const std::size_t start_draws = std::max(fewest_start_draws, start_draws_per_walker * walkers);
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
        log_p = no_density;
        double scale = largest_scatter;
        for (int attempt = 1; scale > smallest_scatter && log_p == no_density; ++attempt) {
            bool moved = true;
            for (std::size_t k = 0; k < d; ++k) {
                const Range range = domain.ranges()[k];
                const double width = range.upper - range.lower;
                const double unit = std::isfinite(width) ? width : std::max(1.0, std::abs(start[k]));
                point[k] = reflected(start[k] + scale * unit * detail::draw_normals(numbers).x, range);
                moved = moved && point[k] != start[k];
            }
            if (moved) density(point, {&log_p, 1});
            if (attempt % scatter_attempts == 0) scale *= 0.5;
        }
        if (log_p == no_density)
            throw Error("sample", "the density is zero about the start of chain " + std::to_string(chain) +
                                      ", where its other walkers start; expected a start for each walker");
        starts.insert(starts.end(), point.begin(), point.end());
    }
    return starts;
}

void expect_spanning_starts(std::span<const double> starts, std::size_t dimensions, bool within_halves,
                            std::uint32_t ensemble) {
    constexpr double tolerance = 1e-10, epsilon = std::numeric_limits<double>::epsilon();
    std::vector<std::vector<double>> basis = difference_columns(starts, dimensions, within_halves ? 2 : 1);
    auto product = [](const std::vector<double>& a, const std::vector<double>& b) {
        return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
    };
    auto divide = [](std::vector<double>& a, double by) {
        for (double& v : a) v /= by;
    };
    double rounding = tolerance; // of a column of unit length
    for (std::size_t k = 0; k < dimensions; ++k) {
        double size = 0, spread = 0;
        for (std::size_t i = k; i < starts.size(); i += dimensions)
            size = std::max(size, std::abs(starts[i]));
        for (double v : basis[k]) spread = std::max(spread, std::abs(v));
        // By the spread first: squares of differences may overflow, or vanish.
        if (spread > 0 && std::isfinite(spread)) {
            divide(basis[k], spread);
            const double norm = std::sqrt(product(basis[k], basis[k]));
            divide(basis[k], norm);
            rounding = std::max(rounding, 4 * epsilon * (size / spread) / norm);
        }
    }
    // Gram and Schmidt, in the modified form.
    for (std::size_t k = 0; k < dimensions; ++k) {
        for (std::size_t j = 0; j < k; ++j) {
            const double share = product(basis[j], basis[k]);
            for (std::size_t i = 0; i < basis[k].size(); ++i) basis[k][i] -= share * basis[j][i];
        }
        const double rest = std::sqrt(product(basis[k], basis[k]));
        if (!(rest > rounding))
            throw Error(
                "sample",
                (within_halves ? "the halves of the walkers of ensemble " : "the walkers of ensemble ") +
                    std::to_string(ensemble) + " lie in a subspace; expected starts that span all variables");
        divide(basis[k], rest);
    }
}

} // namespace montelux
