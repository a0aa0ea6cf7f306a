#include "montelux/mc/integrate/adaptive/mixture_sampling.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "montelux/mc/integrate/adaptive/device_mixture.h"
#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

// Consecutive points of one channel and replicate.
struct Chunk {
    int replicate, channel;
    std::uint64_t first, count;
    std::uint64_t number; // of its first point among those of all replicates in turn
};

// The points of one chunk, kept until all are put in order.
struct Kept {
    PointBuffer x;
    ValueBuffer g;
    std::vector<double> density;
};

} // namespace

void MixtureSums::merge(const MixtureSums& later) {
    sums.merge(later.sums);
    non_finite.merge(later.non_finite);
    evaluations += later.evaluations;
    if (extremes.components() == 0)
        extremes = later.extremes;
    else if (later.extremes.components() > 0)
        extremes.merge(later.extremes);
    channels.resize(std::max(channels.size(), later.channels.size()));
    for (std::size_t k = 0; k < later.channels.size(); ++k) {
        channels[k].count += later.channels[k].count;
        channels[k].sum += later.channels[k].sum;
        channels[k].squares += later.channels[k].squares;
    }
}

double MixtureSums::independent_variance(std::uint64_t n) const {
    double variance = 0;
    for (const Channel& c : channels)
        if (c.count > 0) variance += std::max(0.0, c.squares - c.sum * c.sum / static_cast<double>(c.count));
    return variance / (static_cast<double>(n) * static_cast<double>(n));
}

void MixtureSums::save(StateWriter& state) const {
    state.put(sums.all());
    montelux::save(state, non_finite);
    state.put(evaluations);
    extremes.save(state);
    state.put(static_cast<std::uint64_t>(channels.size()));
    for (const Channel& c : channels) {
        state.put(c.count);
        state.put(c.sum);
        state.put(c.squares);
    }
}

void MixtureSums::load(StateReader& state) {
    std::vector<double> all = state.get_doubles();
    if (all.size() != sums.all().size())
        throw Error("the saved state has another number of replicates or components");
    sums.restore(std::move(all));
    montelux::load(state, non_finite);
    evaluations = state.get_word();
    extremes.load(state);
    channels.clear();
    for (std::uint64_t n = state.get_word(); n > 0; --n) {
        Channel c;
        c.count = state.get_word();
        c.sum = state.get_double();
        c.squares = state.get_double();
        channels.push_back(c);
    }
}

std::optional<MixtureSums> sample_mixture(const Evaluator& evaluator, const MixtureDensity& mixture,
                                          std::uint64_t key, int replicates, std::uint64_t begin,
                                          std::uint64_t end, SamplePoints* points, const CancelFlag* cancel,
                                          DeviceValues* device) {
    constexpr std::uint64_t longest = 4096;
    if (points) device = nullptr;
    std::vector<Chunk> chunks;
    std::uint64_t number = 0;
    for (int r = 0; r < replicates; ++r)
        for (int k = 0; k < mixture.channels(); ++k) {
            const std::uint64_t last = mixture.channel_points(k, end);
            for (std::uint64_t i = mixture.channel_points(k, begin); i < last; i += longest) {
                chunks.push_back({r, k, i, std::min(longest, last - i), number});
                number += chunks.back().count;
            }
        }
    const int components = evaluator.components();
    std::vector<Kept> kept(points ? chunks.size() : 0);
    // `block`: the number of the first point of those that the device has drawn.
    auto run = [&](std::size_t c, std::uint64_t block) {
        const Chunk& chunk = chunks[c];
        MixtureSums total;
        total.sums = ReplicateSums(replicates, components);
        total.extremes = ExtremeValues(components);
        total.channels.resize(static_cast<std::size_t>(mixture.channels()));
        MixtureSums::Channel& channel = total.channels[static_cast<std::size_t>(chunk.channel)];
        channel.count = chunk.count;
        std::optional<ScrambledSobol> sobol;
        const auto fill = [&](PointBuffer& to, std::uint64_t i) {
            if (!sobol)
                sobol.emplace(mixture.dimensions(), hash_key(key, chunk.channel),
                              static_cast<std::uint32_t>(chunk.replicate));
            sobol->fill(to, chunk.first + i);
        };
        // Points that are kept stay in one piece.
        const std::uint64_t batch = points ? longest : batch_size;
        PointBuffer u, x;
        ValueBuffer g;
        std::vector<double> density, weights;
        for (std::uint64_t i = 0; i < chunk.count; i += batch) {
            const std::uint64_t n = std::min(batch, chunk.count - i);
            if (device) {
                const auto all = [&](PointBuffer& to) {
                    u.resize(n, mixture.dimensions());
                    fill(u, i);
                    mixture.place(chunk.channel, u, to);
                };
                device->read_inside(chunk.number - block + i, n, g, density, all, total.non_finite);
            } else {
                u.resize(n, mixture.dimensions());
                fill(u, i);
                mixture.sample(chunk.channel, u, x, density);
                g.resize(x.count(), components);
                if (x.count() > 0) evaluator(x, g, total.non_finite);
            }
            if (density.empty()) continue;
            total.evaluations += density.size();
            const bool weighted = mixture.channels() > 1;
            for (int m = 0; m < components; ++m) {
                double sum = 0, squares = 0;
                std::span<const double> values = g.component(m);
                weights.assign(values.begin(), values.end());
                for (std::size_t j = 0; weighted && j < values.size(); ++j) weights[j] /= density[j];
                for (double w : weights) {
                    sum += w;
                    squares += w * w;
                }
                total.sums.sum(chunk.replicate, m) += sum;
                total.extremes.add(m, weights);
                if (m > 0) continue;
                channel.sum += sum;
                channel.squares += squares;
            }
            if (points) kept[c] = {x, g, density};
        }
        return total;
    };
    auto combine = [](MixtureSums a, const MixtureSums& b) {
        a.merge(b);
        return a;
    };
    const auto sum_of = [&](std::size_t first, std::size_t last, std::uint64_t block) {
        return parallel_reduce_ordered(
            static_cast<std::int64_t>(last - first),
            [&](std::int64_t c) { return run(first + static_cast<std::size_t>(c), block); }, combine, cancel);
    };
    if (device) {
        set_mixture(device->sampler(), mixture, key, replicates, begin, end);
        std::optional<MixtureSums> all;
        for (std::size_t first = 0; first < chunks.size();) {
            const std::uint64_t block = chunks[first].number;
            std::uint64_t count = chunks[first].count;
            std::size_t last = first + 1;
            for (; last < chunks.size() && count + chunks[last].count <= device->block_size(); ++last)
                count += chunks[last].count;
            device->draw_mixture(block, count);
            auto sums = sum_of(first, last, block);
            if (!sums) return sums;
            if (all)
                all->merge(*sums);
            else
                all = std::move(sums);
            first = last;
        }
        return all;
    }
    auto sums = sum_of(0, chunks.size(), 0);
    if (!sums || !points) return sums;

    std::size_t count = 0;
    for (const Kept& part : kept) count += part.density.size();
    points->x.resize(count, mixture.dimensions());
    points->g.resize(count, components);
    points->density.clear();
    for (const Kept& part : kept) {
        const std::size_t at = points->density.size();
        for (std::size_t i = 0; i < part.density.size(); ++i) {
            for (int d = 0; d < mixture.dimensions(); ++d) points->x(at + i, d) = part.x.view()(i, d);
            for (int m = 0; m < components; ++m) points->g.view()(at + i, m) = part.g(i, m);
        }
        points->density.insert(points->density.end(), part.density.begin(), part.density.end());
    }
    return sums;
}

} // namespace montelux
