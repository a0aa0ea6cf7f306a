#include "montelux/render/sample_allocation.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <span>
#include <string>

#include "montelux/mc/math/compensated.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/render/stopping_rule.h"

namespace montelux {
namespace {

constexpr std::uint64_t longest_round = 16;
constexpr std::uint32_t points_for_targets = 8;
constexpr std::uint32_t groups_of_chains = 32, chain_samples_for_targets = 2;
constexpr std::uint32_t many_samples = 256; // from here on split into 16 replicates
// Samples and replicates of the pilot of adaptive renders.
constexpr std::uint64_t pilot_samples = 16, pilot_replicates = 4;

constexpr int radius = 3;               // of the neighbourhood of a pixel
constexpr double least_share = 1.0 / 3; // of the mean number of samples
constexpr double least_growth = 1.1, most_growth = 2;

// Standard deviation of one sample of each pixel, estimated from the pixels around it.
std::vector<double> deviations(const Film& film) {
    const int width = film.bounds().width(), height = film.bounds().height();
    std::vector<double> variance(film.pixels().size());
    parallel_for(
        static_cast<std::int64_t>(variance.size()),
        [&](std::int64_t i) {
            const Pixel& p = film.pixels()[static_cast<std::size_t>(i)];
            const double error = luminance_error(p);
            variance[static_cast<std::size_t>(i)] =
                std::isfinite(error) ? error * error * static_cast<double>(p.samples()) : 0;
        },
        nullptr, 1024);
    auto at = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    };
    // Summed anew for each pixel: rounding in running sums would let the pixel's own value in again.
    auto around = [&](int x0, int y0) {
        double sum = 0;
        int count = 0;
        for (int y = std::max(0, y0 - radius); y < std::min(height, y0 + radius + 1); ++y)
            for (int x = std::max(0, x0 - radius); x < std::min(width, x0 + radius + 1); ++x)
                if (x != x0 || y != y0) {
                    sum += variance[at(x, y)];
                    ++count;
                }
        return count > 0 ? sum / count : variance[at(x0, y0)]; // a picture of one pixel
    };
    std::vector<double> result(variance.size());
    parallel_for(height, [&](std::int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < width; ++x) result[at(x, y)] = std::sqrt(around(x, y));
    });
    CompensatedSum total;
    for (double s : result) total.add(s);
    const double least = least_share * total.value() / static_cast<double>(result.size());
    for (double& s : result) s = std::max(s, least);
    return result;
}

// Where a quantile of the errors is small enough and some pixels have too few samples to believe it: the samples they
// lack. Empty otherwise, or if that is more than may be taken.
std::vector<std::uint32_t> missing_to_trust(const Film& film, const SampleOrder& order,
                                            const RenderTarget& target) {
    if (!(target.error > 0 && target.quantile > 0)) return {};
    const std::uint64_t trusted = samples_to_trust(target, order.replicate_size());
    const std::span<const Pixel> pixels = film.pixels();
    if (std::ranges::all_of(pixels, [&](const Pixel& p) { return p.samples() >= trusted; })) return {};
    if (!(error_quantile(film, target.quantile) <= target.error)) return {};
    std::vector<std::uint32_t> target_samples(pixels.size());
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        target_samples[i] = static_cast<std::uint32_t>(std::max<std::uint64_t>(pixels[i].samples(), trusted));
        total += target_samples[i];
    }
    return total <= order.share() * pixels.size() ? target_samples : std::vector<std::uint32_t>();
}

} // namespace

std::uint64_t pilot_of(const SampleOrder& order) {
    const std::uint64_t samples = std::max(pilot_samples, pilot_replicates * order.replicate_size());
    return (samples + order.replicate_size() - 1) / order.replicate_size() * order.replicate_size();
}

SamplerSettings with_replicates(SamplerSettings settings, const RenderTarget& target) {
    if (settings.chains) {
        if (settings.replicate_points != 0) return settings;
        const std::uint32_t groups = std::max(groups_of_chains, target.slice.count);
        settings.replicate_points = std::max(1u, settings.spp / groups);
        if (target.error > 0 || target.time > 0)
            settings.replicate_points = std::min(settings.replicate_points, chain_samples_for_targets);
        return settings;
    }
    if (settings.kind == SamplerKind::independent || settings.replicates >= 2 ||
        settings.replicate_points != 0)
        return settings;
    if (target.error > 0 || target.time > 0)
        settings.replicate_points = std::clamp(settings.spp / 8, 1u, points_for_targets);
    else if (target.adaptive) // pixels that get a third of the samples still have twenty replicates
        settings.replicate_points = std::clamp(std::bit_floor(settings.spp / 64), 1u, points_for_targets);
    else
        settings.replicates =
            std::min(std::max(settings.spp < many_samples ? 8u : 16u, target.slice.count), settings.spp);
    return settings;
}

SamplerSettings with_points(SamplerSettings settings, std::uint32_t replicate_points) {
    if (replicate_points != 0) settings.replicate_points = replicate_points;
    return settings;
}

void check_slice(const SamplerSettings& sampler, const RenderTarget& target) {
    const Slice& slice = target.slice;
    if (slice.index >= slice.count)
        throw Error("slices are counted from 0, and there are " + std::to_string(slice.count));
    if (SampleOrder(with_replicates(sampler, target), slice).share() == 0)
        throw Error("there are fewer replicates than slices; more samples per pixel are needed");
}

std::vector<std::uint32_t> next_target_samples(const RenderState& state, const SamplerSettings& sampler,
                                               const RenderTarget& target) {
    const SampleOrder order(sampler, target.slice);
    const std::uint64_t share = order.share();
    const std::size_t pixels = state.film.pixels().size();
    const std::uint64_t begin = state.target_samples.empty() ? 0 : state.target_samples.front();
    const std::uint64_t pilot = target.adaptive ? pilot_of(order) : 0;
    if (target.adaptive && begin >= pilot) {
        std::vector<std::uint32_t> missing = missing_to_trust(state.film, order, target);
        return missing.empty() ? neyman_allocation(state.film, order, target) : missing;
    }
    if (begin >= share) return {};
    if (sampler.chains) { // the same numbers of whole groups
        const std::uint64_t groups = begin / order.replicate_size();
        const std::uint64_t more = std::clamp<std::uint64_t>(std::bit_floor(groups), 1, longest_round);
        const std::uint64_t end = std::min(begin + more * order.replicate_size(), share);
        return std::vector<std::uint32_t>(pixels, static_cast<std::uint32_t>(end));
    }
    // 1, 2, 4, 8, 16, 32, 48, ... samples: a render that is interrupted early has some in every pixel.
    std::uint64_t end = begin + std::clamp<std::uint64_t>(std::bit_floor(begin), 1, longest_round);
    if (order.replicate_size() > 1 || state.splats) // passes end with a round
        end = std::min(end, (begin / order.replicate_size() + 1) * order.replicate_size());
    if (target.adaptive) end = std::min(end, pilot);
    return std::vector<std::uint32_t>(pixels, static_cast<std::uint32_t>(std::min(end, share)));
}

std::vector<std::uint32_t> neyman_allocation(const Film& film, const SampleOrder& order,
                                             const RenderTarget& target) {
    const std::vector<double> weight = deviations(film);
    const std::size_t n = weight.size();
    const double pixels = static_cast<double>(n), replicate = order.replicate_size();
    CompensatedSum taken, weights;
    for (const Pixel& p : film.pixels()) taken.add(p.samples());
    for (double w : weight) weights.add(w);
    const double most = static_cast<double>(order.share()) * pixels;
    if (taken.value() + replicate > most) return {};

    // n_p = scale * weight_p, at least the current count.
    auto target_of = [&](std::size_t i, double scale) {
        const double wanted = std::min(std::ceil(scale * weight[i] / replicate) * replicate, 4e9);
        return std::max(static_cast<double>(film.pixels()[i].samples()), wanted);
    };
    // Sums of whole numbers are exact in any order.
    auto total = [&](double scale) {
        constexpr std::size_t run = 4096;
        return parallel_reduce_ordered(
            static_cast<std::int64_t>((n + run - 1) / run),
            [&](std::int64_t r) {
                const std::size_t first = static_cast<std::size_t>(r) * run, last = std::min(n, first + run);
                double sum = 0;
                for (std::size_t i = first; i < last; ++i) sum += target_of(i, scale);
                return sum;
            },
            std::plus<>());
    };
    // The largest scale whose total is within a limit.
    auto scale_within = [&](double limit) {
        double low = 0, high = weights.value() > 0 ? 2 * limit / weights.value() : 0;
        for (int i = 0; i < 50; ++i) {
            const double middle = 0.5 * (low + high);
            (total(middle) <= limit ? low : high) = middle;
        }
        return low;
    };
    double limit = std::min(most_growth * taken.value(), most);
    if (target.error > 0 && target.quantile == 0) {
        // Mean over pixels of w^2 / (scale w) = (error * mean luminance)^2.
        const double tolerance = target.error * error_of(film).mean_luminance;
        const double scale = weights.value() / (pixels * tolerance * tolerance);
        if (std::isfinite(scale))
            limit = std::min(limit, std::max(total(scale), std::min(least_growth * taken.value(), most)));
    }
    if (target.error > 0 && target.quantile > 0) {
        const double ratio = error_quantile(film, target.quantile) / target.error;
        limit = std::min(limit, std::max(ratio * ratio, least_growth) * taken.value());
    }
    const double scale = scale_within(limit);
    std::vector<std::uint32_t> target_samples(n);
    bool more = false;
    for (std::size_t i = 0; i < n; ++i) {
        target_samples[i] = static_cast<std::uint32_t>(target_of(i, scale));
        more = more || target_samples[i] > film.pixels()[i].samples();
    }
    // If replicates exceed the limit, or nothing varies: equal counts, as far as allowed.
    if (!more) {
        const std::uint64_t room = static_cast<std::uint64_t>((most - taken.value()) / (pixels * replicate));
        if (room == 0) return {};
        for (std::size_t i = 0; i < n; ++i)
            target_samples[i] = film.pixels()[i].samples() + order.replicate_size();
    }
    return target_samples;
}

void join_rounds(RenderState& state, const SampleOrder& order, const RenderTarget& target) {
    const std::uint32_t next = state.target_samples.front();
    const auto take = [&](std::uint64_t samples) {
        std::ranges::fill(state.target_samples, static_cast<std::uint32_t>(std::min(samples, order.share())));
    };
    if (state.splats) {
        const std::uint64_t points = order.replicate_size();
        take((next + points - 1) / points * points);
    } else if (target.adaptive) {
        if (next < std::min(pilot_of(order), order.share())) take(pilot_of(order));
    } else if (!(target.error > 0)) {
        take(order.share());
    }
}

} // namespace montelux
