#include "montelux/mc/integrate/metropolis/metropolis_walkers.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "montelux/mc/integrate/metropolis/metropolis_chain.h"

namespace montelux {
namespace {

constexpr std::size_t group_size = 8; // chains whose proposals are evaluated together
constexpr int watched_coordinates = 8;
constexpr std::uint32_t walk_stream = 3;

} // namespace

double component_ratios(const ValueBuffer& g, std::size_t i, const std::vector<double>& inverse_scale,
                        std::vector<double>& mean) {
    double size = 0;
    for (std::size_t c = 0; c < mean.size(); ++c) {
        mean[c] = g(i, static_cast<int>(c));
        size += mean[c] * inverse_scale[c] * mean[c] * inverse_scale[c];
    }
    size = mean.size() == 1 ? std::abs(mean[0]) * inverse_scale[0] : std::sqrt(size);
    if (size > 0)
        for (double& h : mean) h /= size;
    return size;
}

int Walkers::observables(const Evaluator& g) {
    return g.components() + 1 + std::min(watched_coordinates, g.dimensions());
}

std::optional<WalkCounts> Walkers::walk(const Problem& problem, std::uint64_t states, std::uint32_t number,
                                        std::uint32_t window, CovarianceMoments* seen,
                                        const CancelFlag* cancel) {
    const std::size_t groups = (chains.size() + group_size - 1) / group_size;
    struct Part {
        WalkCounts counts;
        CovarianceMoments seen;
    };
    auto part = parallel_reduce_ordered(
        static_cast<std::int64_t>(groups),
        [&](std::int64_t group) {
            Part own{{}, CovarianceMoments(seen ? problem.evaluator.dimensions() : 0)};
            walk_group(problem, static_cast<std::size_t>(group) * group_size, states, number, window,
                       seen ? &own.seen : nullptr, own.counts);
            return own;
        },
        [](Part a, const Part& b) {
            a.counts.merge(b.counts);
            a.seen.merge(b.seen);
            return a;
        },
        cancel);
    if (!part) return std::nullopt;
    if (seen) *seen = part->seen;
    return part->counts;
}

void Walkers::walk_group(const Problem& problem, std::size_t first, std::uint64_t states,
                         std::uint32_t number, std::uint32_t window, CovarianceMoments* seen,
                         WalkCounts& counts) {
    const Evaluator& g = problem.evaluator;
    const auto d = static_cast<std::size_t>(g.dimensions());
    const std::size_t lanes = std::min(group_size, chains.size() - first);
    std::vector<PhiloxStream> numbers;
    for (std::size_t l = 0; l < lanes; ++l)
        numbers.emplace_back(
            hash_key(problem.seed, walk_stream),
            std::array<std::uint32_t, 3>{static_cast<std::uint32_t>(first + l), number, window});
    PointBuffer u;
    ValueBuffer values;
    std::vector<double> normals(d + 1), proposed(d), mean(static_cast<std::size_t>(g.components())),
        observed(static_cast<std::size_t>(observables(g)));
    std::vector<std::vector<double>> inside;
    std::vector<std::size_t> lane;
    for (std::uint64_t t = 0; t < states; ++t) {
        lane.clear();
        inside.resize(lanes);
        for (std::size_t l = 0; l < lanes; ++l) {
            PhiloxStream& stream = numbers[l];
            for (std::size_t k = 0; k < d; k += 2) {
                const Vec2d z = detail::draw_normals(stream);
                normals[k] = z.x;
                normals[k + 1] = z.y;
            }
            const WalkingChain& chain = chains[first + l];
            bool in = true;
            for (std::size_t i = 0; i < d; ++i) {
                double sum = 0;
                for (std::size_t k = 0; k <= i; ++k) sum += factor[i * d + k] * normals[k];
                proposed[i] = chain.u[i] + step * sum;
                in = in && proposed[i] > 0 && proposed[i] < 1;
            }
            if (!in) continue; // s is zero outside of the cube: the chain stays
            inside[lane.size()] = proposed;
            lane.push_back(l);
        }
        u.resize(lane.size(), g.dimensions());
        values.resize(lane.size(), g.components());
        for (std::size_t i = 0; i < lane.size(); ++i)
            for (std::size_t k = 0; k < d; ++k) u(i, static_cast<int>(k)) = inside[i][k];
        if (!lane.empty()) g(u, values, counts.non_finite);
        counts.evaluations += lane.size();
        counts.proposed += lanes;
        for (std::size_t i = 0; i < lane.size(); ++i) {
            WalkingChain& chain = chains[first + lane[i]];
            const double size = component_ratios(values, i, inverse_scale, mean);
            const double uniform = numbers[lane[i]].next_double();
            if (!(uniform * chain.size < size)) continue;
            chain.u.swap(inside[i]);
            chain.mean = mean;
            chain.size = size;
            ++counts.accepted;
        }
        for (std::size_t l = 0; l < lanes; ++l) {
            WalkingChain& chain = chains[first + l];
            if (seen) seen->add(chain.u);
            if (window > 0) continue;
            std::copy(chain.mean.begin(), chain.mean.end(), observed.begin());
            observed[mean.size()] = std::log(chain.size);
            for (std::size_t k = mean.size() + 1; k < observed.size(); ++k)
                observed[k] = chain.u[k - mean.size() - 1];
            traces[first + l].add(observed);
        }
    }
}

} // namespace montelux
