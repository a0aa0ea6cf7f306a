#include "montelux/transport/strategy_weight.h"

#include <algorithm>
#include <span>

#include "montelux/mc/integrate/mis.h"

namespace montelux {

namespace {

// The densities of all strategies of a path of three vertices or more, but for a common factor.
void find_densities(const PathDensities& path, std::vector<double>& scratch) {
    const std::size_t n = path.vertices();
    // Products over vertices, each divided by the larger of its two densities: only ratios count, and no product of
    // many becomes infinite.
    const auto scale = [&](std::size_t i) {
        const double largest = std::max(path.from_light[i], path.from_camera[i]);
        return largest > 0 ? 1 / largest : 1;
    };
    scratch.assign(path.merging.empty() ? n : 2 * n - 1, 0);
    double product = 1; // over the vertices of the camera's side
    for (std::size_t k = n - 1; k >= 2; --k) {
        scratch[k] = product;
        product *= path.from_camera[k - 1] * scale(k - 1);
    }
    const auto merges = [&](std::size_t i) { return i < path.merging.size() && path.delta[i] == 0; };
    if (merges(1)) scratch[n + 1] = product * path.from_light[0] * path.from_light[1] * path.merging[1];
    scratch[1] = product * path.next_event;
    scratch[0] = product * path.from_camera[0];
    product = path.from_light[0] * path.from_light[1] * scale(1);
    for (std::size_t k = 2; k < n; ++k) {
        scratch[k] *= product;
        if (k < n - 1 && merges(k)) scratch[n + k] = scratch[k] * path.from_light[k] * path.merging[k];
        if (k < n - 1) product *= path.from_light[k] * scale(k);
    }
    scratch[n - 1] *= path.light_paths;

    if (!path.media.empty()) {
        for (std::size_t k = 0; k < n; ++k) scratch[k] *= path.media[k];
        // Merging walks all edges, as s = 0 does.
        for (std::size_t k = n; k < scratch.size(); ++k) scratch[k] *= path.media[0];
    }
    for (std::size_t k = 0; k < n; ++k) {
        const bool joins_deltas =
            (k >= 2 && path.delta[k - 1] != 0) || (k >= 1 && k < n - 1 && path.delta[k] != 0);
        if (joins_deltas) scratch[k] = 0;
    }
}

} // namespace

double strategy_weight(const PathDensities& path, std::size_t s, Heuristic heuristic,
                       std::vector<double>& scratch) {
    if (path.vertices() == 2) return s == 0 ? 1 : 0;
    find_densities(path, scratch);
    const MisHeuristic mis = heuristic == Heuristic::power ? MisHeuristic::power() : MisHeuristic::balance();
    return mis_weight(mis, std::span(scratch), s);
}

double path_tracing_density(const PathDensities& path, std::size_t s, std::vector<double>& scratch) {
    if (path.vertices() == 2) return 1;
    find_densities(path, scratch);
    return (scratch[0] + scratch[1]) / scratch[s];
}

} // namespace montelux
