#include "montelux/mc/integrate/adaptive/difference_walk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "montelux/mc/random/philox_stream.h"

namespace montelux {
namespace {

constexpr double shortest_step = 0.05; // relative to the best one for a Gaussian, for ridges that bend
// Shares of the coordinates that a proposal moves: some of them may bend where others do not.
constexpr std::array moved_shares{1 / 3., 2 / 3., 1.};
constexpr double least_snooker = 1.2; // and 2.2 at most, around the best length for a Gaussian, 1.7
constexpr double whole_steps = 0.125; // share of proposals by a whole difference, from peak to like peak

// Systematic draws of indices by weight.
std::vector<std::size_t> draw_by_weight(std::span<const double> weights, std::size_t count, double u) {
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    std::vector<std::size_t> drawn;
    double sum = 0;
    std::size_t i = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const double at = (static_cast<double>(k) + u) / static_cast<double>(count) * total;
        while (i + 1 < weights.size() && sum + weights[i] <= at) sum += weights[i++];
        drawn.push_back(i);
    }
    return drawn;
}

} // namespace

WalkedPoints walk_by_differences(const DensityFunction& h, const PointBatch& x,
                                 std::span<const double> h_at_x, std::span<const double> weights,
                                 const DifferenceWalk& settings) {
    const int n = x.dimensions();
    const std::size_t walkers = settings.walkers / 2 * 2, half = walkers / 2;
    PhiloxStream numbers(settings.key);
    PointBuffer at(walkers, n);
    std::vector<double> here(walkers);
    const std::vector<std::size_t> starts = draw_by_weight(weights, walkers, numbers.next_double());
    for (std::size_t w = 0; w < walkers; ++w) {
        // Neighbours in the order of the draws go to different halves.
        const std::size_t place = w / 2 + (w % 2) * half;
        for (int d = 0; d < n; ++d) at(place, d) = x(starts[w], d);
        here[place] = h_at_x[starts[w]];
    }
    WalkedPoints walked;
    walked.exponent = settings.exponent;
    const double coldness = 1 / settings.exponent;
    walked.x.resize(walkers * settings.steps, n);
    const double best_step = 2.38 / std::sqrt(2.0 * n);
    PointBuffer proposed(half, n);
    std::vector<double> there(half);
    for (std::size_t step = 0; step < settings.steps; ++step) {
        for (std::size_t first : {std::size_t{0}, half}) {
            const std::size_t others = half - first;
            auto draw = [&] {
                return others + std::min(half - 1, static_cast<std::size_t>(numbers.next_double() *
                                                                            static_cast<double>(half)));
            };
            std::vector<char> inside(half, 1);
            auto propose = [&](std::size_t w, int d, double to) {
                inside[w] = inside[w] && to > 0 && to < 1;
                proposed(w, d) = std::clamp(to, 1e-12, 1 - 1e-12);
            };
            const bool snooker = step % 3 == 2;
            std::vector<double> factor(half, 1.0); // of the densities' ratio
            for (std::size_t w = 0; w < half; ++w) {
                const std::size_t a = draw(), b = draw();
                if (snooker) {
                    const std::size_t z = draw();
                    double along = 0, before = 0;
                    for (int d = 0; d < n; ++d) {
                        const double arm = at(first + w, d) - at(z, d);
                        along += (at(a, d) - at(b, d)) * arm;
                        before += arm * arm;
                    }
                    const double length = least_snooker + numbers.next_double();
                    // The walker's distance from z changes by this factor.
                    const double stretch = before > 0 ? 1 + length * along / before : 1;
                    for (int d = 0; d < n; ++d)
                        propose(w, d, at(z, d) + stretch * (at(first + w, d) - at(z, d)));
                    factor[w] = std::pow(std::abs(stretch), n - 1);
                    continue;
                }
                const double part = numbers.next_double();
                const double length =
                    part < whole_steps
                        ? 1
                        : best_step * std::pow(shortest_step, (part - whole_steps) / (1 - whole_steps));
                const double moved = moved_shares[std::min<std::size_t>(
                    moved_shares.size() - 1,
                    static_cast<std::size_t>(numbers.next_double() * moved_shares.size()))];
                for (int d = 0; d < n; ++d) {
                    const bool moves = numbers.next_double() < moved;
                    propose(w, d, at(first + w, d) + (moves ? length * (at(a, d) - at(b, d)) : 0));
                }
            }
            h(proposed, there);
            for (std::size_t w = 0; w < half; ++w) {
                // Accepted with probability (h'/h)^exponent times the factor.
                if (!inside[w] || !(there[w] * std::pow(factor[w], coldness) >
                                    std::pow(numbers.next_double(), coldness) * here[first + w]))
                    continue;
                for (int d = 0; d < n; ++d) at(first + w, d) = proposed(w, d);
                here[first + w] = there[w];
            }
        }
        for (std::size_t w = 0; w < walkers; ++w)
            for (int d = 0; d < n; ++d) walked.x(step * walkers + w, d) = at(w, d);
        walked.h.insert(walked.h.end(), here.begin(), here.end());
    }
    return walked;
}

} // namespace montelux
