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
            for (std::size_t w = 0; w < half; ++w) {
                const std::size_t a = draw(), b = draw();
                const double length = best_step * std::pow(shortest_step, numbers.next_double());
                for (int d = 0; d < n; ++d) {
                    const double to = at(first + w, d) + length * (at(a, d) - at(b, d));
                    inside[w] = inside[w] && to > 0 && to < 1;
                    proposed(w, d) = std::clamp(to, 1e-12, 1 - 1e-12);
                }
            }
            h(proposed, there);
            for (std::size_t w = 0; w < half; ++w) {
                if (!inside[w] || !(there[w] > numbers.next_double() * here[first + w])) continue;
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
