#include "montelux/mc/integrate/cubature/cubature_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

constexpr double widening = 0.5;      // of the range that a rule saw
constexpr double error_allowance = 4; // times the claimed error density of a region
constexpr double tolerance_part = 0.25;
constexpr double volume_share = 0.6, spread_share = 0.3; // of the points; the rest goes equally to regions
constexpr std::size_t blocks = 16;                       // parts whose spread is the error of the mean
constexpr double far_beyond = 2;                  // factor: values of a hint over those that a rule saw
constexpr std::uint64_t check_task_points = 4096; // unless one region has more
constexpr std::uint64_t stream = 0x6368656b;      // distinct from those of the sampling methods

// The points of one region.
struct Share {
    std::size_t region;
    std::uint64_t count, first; // first: points of the regions before it
    double weight;              // volume over measure
};

// Systematic sampling: a region gets a number of points within one of its share of the measure, the right one
// on average. Most of the measure is volume. A part follows volume times range (Neyman allocation for the
// variance of the difference); and a part is the same for each region, since small regions lie where the
// integrand has structure, and overlooked structure is often nearby.
std::vector<Share> share_out(const CubatureRegions& regions, std::uint64_t count, std::uint64_t key) {
    const double offset = static_cast<double>(hash_key(key, 0) >> 11) * 0x1p-53;
    const std::size_t all = regions.count(), components = regions.value(0).size();
    std::vector<double> spread(all, 0.0); // volume times range, relative to the sum of a component
    for (std::size_t c = 0; c < components; ++c) {
        double sum = 0;
        for (std::size_t r = 0; r < all; ++r)
            sum += regions.volume(r) * (regions.highest(r)[c] - regions.lowest(r)[c]);
        for (std::size_t r = 0; r < all; ++r) {
            const double own = regions.volume(r) * (regions.highest(r)[c] - regions.lowest(r)[c]);
            spread[r] += (sum > 0 ? own / sum : regions.volume(r)) / static_cast<double>(components);
        }
    }
    std::vector<Share> shares;
    double measure = 0;
    std::uint64_t given = 0;
    for (std::size_t r = 0; r < all; ++r) {
        const double volume = regions.volume(r);
        const double own = volume_share * volume + spread_share * spread[r] +
                           (1 - volume_share - spread_share) / static_cast<double>(all);
        measure += own;
        const double end = static_cast<double>(count) * measure - offset;
        const auto until =
            r + 1 == all ? count : std::min(count, static_cast<std::uint64_t>(std::max(0.0, std::ceil(end))));
        if (until > given) shares.push_back({r, until - given, given, volume / own});
        given = std::max(given, until);
    }
    return shares;
}

struct CheckedPart {
    std::vector<CubatureWitness> surprises, hints;
    CovarianceMoments residual;
    std::vector<double> block_sums; // blocks x components
    std::vector<double> missed;
    std::vector<double> lowest, highest;
    std::vector<std::size_t> regions;
    std::vector<double> differences; // of each, components side by side
    NonFiniteCount non_finite;

    CheckedPart() = default;
    CheckedPart(int components, bool full)
        : residual(components, full), block_sums(blocks * static_cast<std::size_t>(components)),
          missed(static_cast<std::size_t>(components)),
          lowest(static_cast<std::size_t>(components), std::numeric_limits<double>::infinity()),
          highest(static_cast<std::size_t>(components), -std::numeric_limits<double>::infinity()) {}

    void merge(const CheckedPart& later) {
        surprises.insert(surprises.end(), later.surprises.begin(), later.surprises.end());
        hints.insert(hints.end(), later.hints.begin(), later.hints.end());
        residual.merge(later.residual);
        regions.insert(regions.end(), later.regions.begin(), later.regions.end());
        differences.insert(differences.end(), later.differences.begin(), later.differences.end());
        for (std::size_t i = 0; i < block_sums.size(); ++i) block_sums[i] += later.block_sums[i];
        for (std::size_t c = 0; c < lowest.size(); ++c) {
            missed[c] += later.missed[c];
            lowest[c] = std::min(lowest[c], later.lowest[c]);
            highest[c] = std::max(highest[c], later.highest[c]);
        }
        non_finite.merge(later.non_finite);
    }
};

void fill_points(const CubatureRegions& regions, std::span<const Share> shares, std::uint64_t key,
                 PointBuffer& u) {
    const int n = u.dimensions();
    PointBuffer inside;
    std::size_t at = 0;
    for (const Share& s : shares) {
        inside.resize(s.count, n);
        if (s.count < 4)
            fill_random(inside, hash_key(key, s.region), 0, 0);
        else
            ScrambledSobol(n, hash_key(key, s.region), 0).fill(inside, 0);
        for (int d = 0; d < n; ++d) {
            const double c = regions.centre(s.region)[static_cast<std::size_t>(d)];
            const double h = regions.half_width(s.region)[static_cast<std::size_t>(d)];
            const std::span<const double> from = inside.view().coordinate(d);
            const std::span<double> to = u.coordinate(d).subspan(at, s.count);
            for (std::size_t i = 0; i < s.count; ++i)
                to[i] =
                    std::clamp(c + h * (2 * from[i] - 1), std::numeric_limits<double>::min(), 1 - 0x1p-53);
        }
        at += s.count;
    }
}

CheckedPart check_some(const Evaluator& evaluator, const CubatureRegions& regions,
                       std::span<const Share> shares, std::uint64_t key, std::span<const double> tolerance,
                       bool full_covariance) {
    const auto m = static_cast<std::size_t>(evaluator.components());
    CheckedPart part(evaluator.components(), full_covariance);
    std::uint64_t count = 0;
    for (const Share& s : shares) count += s.count;
    PointBuffer u(count, evaluator.dimensions());
    fill_points(regions, shares, key, u);
    ValueBuffer g(count, evaluator.components());
    evaluator(u, g, part.non_finite);

    std::vector<double> residual(m);
    std::size_t at = 0;
    for (const Share& s : shares) {
        const double inverse_volume = 1 / regions.volume(s.region);
        part.regions.push_back(s.region);
        part.differences.resize(part.differences.size() + m, 0.0);
        double* const sums = part.differences.data() + part.differences.size() - m;
        const auto witness_at = [&](std::size_t point) {
            CubatureWitness witness{s.region, std::vector<double>(static_cast<std::size_t>(u.dimensions())),
                                    std::vector<double>(m)};
            u.view().gather(point, witness.x.data());
            for (std::size_t c = 0; c < m; ++c) witness.value[c] = g(point, static_cast<int>(c));
            return witness;
        };
        double greatest = 0;
        std::optional<std::size_t> hint;
        for (std::uint64_t i = 0; i < s.count; ++i, ++at) {
            bool surprising = false;
            // Consecutive Sobol' points of a region form one block; small regions rotate.
            const std::size_t block =
                s.count >= blocks ? static_cast<std::size_t>(i * blocks / s.count) : (s.first + i) % blocks;
            for (std::size_t c = 0; c < m; ++c) {
                const double value = g(at, static_cast<int>(c));
                residual[c] = value - regions.value(s.region)[c] * inverse_volume;
                part.block_sums[block * m + c] += s.weight * residual[c];
                sums[c] += s.weight * residual[c];
                part.lowest[c] = std::min(part.lowest[c], value);
                part.highest[c] = std::max(part.highest[c], value);
                const double excess = surprise(regions, s.region, c, value, tolerance[c]);
                surprising = surprising || excess > 0;
                part.missed[c] += s.weight * excess;
                const double seen =
                    std::max(std::abs(regions.lowest(s.region)[c]), std::abs(regions.highest(s.region)[c]));
                if (std::abs(value) > std::max(far_beyond * seen, greatest)) {
                    greatest = std::abs(value);
                    hint = at;
                }
            }
            part.residual.add(residual);
            if (surprising) part.surprises.push_back(witness_at(at));
        }
        if (hint) part.hints.push_back(witness_at(*hint));
    }
    return part;
}

} // namespace

double surprise(const CubatureRegions& regions, std::size_t region, std::size_t component, double value,
                double tolerance) {
    const double low = regions.lowest(region)[component], high = regions.highest(region)[component];
    const double allowed = widening * (high - low) +
                           error_allowance * regions.error(region)[component] / regions.volume(region) +
                           tolerance_part * tolerance;
    return std::max({0.0, value - high - allowed, low - allowed - value});
}

std::optional<CubatureCheck> check_regions(const Evaluator& evaluator, const CubatureRegions& regions,
                                           std::uint64_t count, std::uint64_t seed, std::uint64_t round,
                                           std::span<const double> tolerance, bool full_covariance,
                                           const CancelFlag* cancel) {
    const std::uint64_t key = hash_key(seed, stream, round);
    const std::vector<Share> shares = share_out(regions, count, key);
    std::vector<std::size_t> starts; // of the tasks
    std::uint64_t points = check_task_points;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        if (points >= check_task_points) {
            starts.push_back(i);
            points = 0;
        }
        points += shares[i].count;
    }
    const auto tasks = static_cast<std::int64_t>(starts.size());
    starts.push_back(shares.size());
    auto run = [&](std::int64_t task) {
        const auto t = static_cast<std::size_t>(task);
        return check_some(evaluator, regions, std::span(shares).subspan(starts[t], starts[t + 1] - starts[t]),
                          key, tolerance, full_covariance);
    };
    auto combine = [](CheckedPart a, const CheckedPart& b) {
        a.merge(b);
        return a;
    };
    std::optional<CheckedPart> all = parallel_reduce_ordered(tasks, run, combine, cancel);
    if (!all) return std::nullopt;

    CubatureCheck check;
    check.surprises = std::move(all->surprises);
    check.hints = std::move(all->hints);
    check.residual = std::move(all->residual);
    check.regions = std::move(all->regions);
    check.differences = std::move(all->differences);
    for (double& d : check.differences) d /= static_cast<double>(count);
    check.lowest = std::move(all->lowest);
    check.highest = std::move(all->highest);
    check.missed = std::move(all->missed);
    for (double& missed : check.missed) missed /= static_cast<double>(count);
    check.non_finite = std::move(all->non_finite);
    const std::size_t m = check.lowest.size();
    for (std::size_t c = 0; c < m; ++c) {
        double squares = 0, mean = 0;
        for (std::size_t b = 0; b < blocks; ++b) mean += all->block_sums[b * m + c] / blocks;
        check.difference.push_back(mean * blocks / static_cast<double>(count));
        for (std::size_t b = 0; b < blocks; ++b) squares += std::pow(all->block_sums[b * m + c] - mean, 2);
        check.standard_error.push_back(std::sqrt(squares * blocks / (blocks - 1)) /
                                       static_cast<double>(count));
    }
    return check;
}

} // namespace montelux
