#include "montelux/mc/integrate/chains/draw_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "montelux/mc/integrate/metropolis/chain_agreement.h"
#include "montelux/mc/math/special.h"
#include "montelux/mc/stats/autocovariance.h"
#include "montelux/mc/stats/moments.h"

namespace montelux {
namespace {

// The two halves of each chain one after the other; the middle draw of an odd number is left out.
std::vector<double> split_in_halves(std::span<const double> values, std::size_t chains) {
    const std::size_t draws = values.size() / chains, half = draws / 2;
    std::vector<double> parts;
    parts.reserve(2 * half * chains);
    for (std::size_t c = 0; c < chains; ++c)
        for (std::size_t begin : {c * draws, (c + 1) * draws - half})
            parts.insert(parts.end(), values.begin() + static_cast<std::ptrdiff_t>(begin),
                         values.begin() + static_cast<std::ptrdiff_t>(begin + half));
    return parts;
}

// Equation 14 of Vehtari et al.: normal scores of average ranks, in place of the values.
void normalise_ranks(std::span<double> values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
        for (end = begin; end < order.size() && values[order[end]] == values[order[begin]];) ++end;
        const double rank = 0.5 * static_cast<double>(begin + 1 + end);
        const double score = normal_quantile((rank - 0.375) / (static_cast<double>(values.size()) + 0.25));
        for (std::size_t i = begin; i < end; ++i) values[order[i]] = score;
    }
}

// The moments of each of `parts` equally long parts: their means, and the mean of their variances.
struct PartMoments {
    RunningMoments means;
    double within = 0;

    PartMoments(std::span<const double> values, std::size_t parts) {
        const std::size_t length = values.size() / parts;
        for (std::size_t p = 0; p < parts; ++p) {
            RunningMoments part;
            for (double v : values.subspan(p * length, length)) part.add(v);
            means.add(part.mean());
            within += part.variance() / static_cast<double>(parts);
        }
    }
    double r_hat(std::size_t length) const {
        return r_hat_of(static_cast<double>(length), within, means.variance());
    }
    // Of a draw, as all parts together estimate it (var^+ of the paper).
    double variance(std::size_t length) const {
        const double n = static_cast<double>(length);
        return within * (n - 1) / n + means.variance();
    }
};

// The means over the walkers of each ensemble, part by part; `parts` holds two halves of each walker.
std::vector<double> ensemble_means(std::span<const double> values, std::size_t parts, std::size_t walkers) {
    const std::size_t length = values.size() / parts, ensembles = parts / 2 / walkers;
    std::vector<double> means(2 * ensembles * length, 0.0);
    for (std::size_t p = 0; p < parts; ++p) {
        const std::size_t to = 2 * (p / 2 / walkers) + p % 2;
        for (std::size_t i = 0; i < length; ++i)
            means[to * length + i] += values[p * length + i] / static_cast<double>(walkers);
    }
    return means;
}

// Section 3.2 of Vehtari et al.: the autocorrelations of all parts together, summed up to where pairs of neighbours
// stop being positive and made to fall (Geyer's initial monotone sequence). `parts` holds two halves of each chain.
double effective_size(std::span<const double> values, std::size_t parts, std::size_t walkers) {
    const std::size_t length = values.size() / parts;
    const double draws = static_cast<double>(values.size());
    std::vector<double> means;
    if (walkers > 1) means = ensemble_means(values, parts, walkers);
    const std::span<const double> series = walkers > 1 ? means : values;
    const std::size_t count = parts / walkers;
    const PartMoments moments(series, count);
    const double variance = moments.variance(length);
    if (!(variance > 0)) return draws;
    std::vector<double> covariances(length, 0.0);
    for (std::size_t p = 0; p < count; ++p) {
        const std::vector<double> own = autocovariance(series.subspan(p * length, length));
        for (std::size_t k = 0; k < length; ++k) covariances[k] += own[k] / static_cast<double>(count);
    }
    auto correlation = [&](std::size_t lag) {
        return lag == 0 ? 1 : 1 - (moments.within - covariances[lag]) / variance;
    };
    double time = -1, last = std::numeric_limits<double>::infinity();
    for (std::size_t lag = 0;; lag += 2) {
        const double even = correlation(lag), pair = even + correlation(lag + 1);
        if (!(pair > 0) || lag + 4 >= length) { // of the last pair the even lag alone, as in Stan
            time += std::max(0.0, even);
            break;
        }
        last = std::min(last, pair);
        time += 2 * last;
    }
    // Antithetic chains are worth more than independent draws, within reason.
    time = std::max(time, 1 / std::log10(static_cast<double>(series.size())));
    const double variance_of_mean = variance * time / static_cast<double>(series.size());
    return PartMoments(values, parts).variance(length) / variance_of_mean;
}

double quantile_of(const std::vector<double>& sorted, double probability) {
    const double at = probability * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const double next = sorted[std::min(below + 1, sorted.size() - 1)];
    return sorted[below] + (at - static_cast<double>(below)) * (next - sorted[below]);
}

} // namespace

DrawSummary summarize_draws(std::span<const double> values, std::size_t chains, std::size_t walkers) {
    constexpr std::size_t fewest = 8; // two halves of four
    DrawSummary summary;
    RunningMoments all;
    for (double v : values) all.add(v);
    summary.mean = all.mean();
    summary.standard_deviation = all.standard_deviation();
    const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
    if (values.size() < fewest * chains || *lowest == *highest) {
        summary.standard_error = summary.r_hat = std::numeric_limits<double>::infinity();
        return summary;
    }
    // `work` is all the memory that is taken beside the halves and the order of ranks: chains may be long.
    const std::vector<double> split = split_in_halves(values, chains);
    const std::size_t parts = 2 * chains, length = split.size() / parts;
    std::vector<double> work(values.begin(), values.end());
    std::sort(work.begin(), work.end());
    const double low = quantile_of(work, 0.05), high = quantile_of(work, 0.95);
    work = split;
    std::sort(work.begin(), work.end());
    const double median = quantile_of(work, 0.5);
    auto transform = [&](auto function) {
        std::transform(split.begin(), split.end(), work.begin(), function);
    };
    transform([&](double v) { return std::abs(v - median); });
    normalise_ranks(work);
    const double folded = PartMoments(work, parts).r_hat(length);
    work = split;
    normalise_ranks(work);
    summary.r_hat = std::max(PartMoments(work, parts).r_hat(length), folded);
    summary.bulk_effective_size = effective_size(work, parts, walkers);
    summary.tail_effective_size = std::numeric_limits<double>::infinity();
    for (double quantile : {low, high}) {
        transform([&](double v) { return v <= quantile ? 1.0 : 0.0; });
        summary.tail_effective_size =
            std::min(summary.tail_effective_size, effective_size(work, parts, walkers));
    }
    summary.standard_error = summary.standard_deviation / std::sqrt(effective_size(split, parts, walkers));
    return summary;
}

} // namespace montelux
