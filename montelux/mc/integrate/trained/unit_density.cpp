#include "montelux/mc/integrate/trained/unit_density.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// The first coordinates of a batch.
PointBatch first_coordinates(const PointBatch& v, int dimensions) {
    return {v.data(), v.count(), dimensions, v.stride()};
}

void draw_from(const AdaptiveMap& map, const PointBatch& v, UnitDraws& draws) {
    draws.u.resize(v.count(), map.dimensions());
    draws.density.assign(v.count(), 1.0);
    draws.index.resize(v.count());
    std::iota(draws.index.begin(), draws.index.end(), std::size_t{0});
    map.map(first_coordinates(v, map.dimensions()), draws.u, draws.density);
    for (double& p : draws.density) p = 1 / p;
}

void draw_from(const MixtureDensity& mixture, const PointBatch& v, UnitDraws& draws) {
    const int n = mixture.dimensions();
    // The draws of each channel.
    std::vector<std::vector<std::size_t>> members(static_cast<std::size_t>(mixture.channels()));
    std::vector<std::size_t> channel_of;
    for (std::size_t k = 0; k < members.size(); ++k)
        channel_of.insert(channel_of.end(), static_cast<std::size_t>(mixture.shares()[k]), k);
    for (std::size_t i = 0; i < v.count(); ++i)
        members[channel_of[static_cast<std::size_t>(v(i, n) * MixtureDensity::units)]].push_back(i);

    // Points of all draws in their order; a density of zero marks those outside of the cube.
    PointBuffer all(v.count(), n), own, x;
    std::vector<double> density(v.count(), 0.0), own_density;
    std::vector<std::size_t> inside;
    for (std::size_t k = 0; k < members.size(); ++k) {
        if (members[k].empty()) continue;
        own.resize(members[k].size(), n);
        for (int d = 0; d < n; ++d)
            for (std::size_t j = 0; j < members[k].size(); ++j) own(j, d) = v(members[k][j], d);
        mixture.sample(static_cast<int>(k), own, x, own_density, &inside);
        for (std::size_t j = 0; j < inside.size(); ++j) {
            const std::size_t i = members[k][inside[j]];
            for (int d = 0; d < n; ++d) all(i, d) = x(j, d);
            density[i] = own_density[j];
        }
    }
    draws.index.clear();
    draws.density.clear();
    for (std::size_t i = 0; i < v.count(); ++i) {
        if (!(density[i] > 0)) continue;
        draws.index.push_back(i);
        draws.density.push_back(density[i]);
    }
    draws.u.resize(draws.index.size(), n);
    for (int d = 0; d < n; ++d)
        for (std::size_t j = 0; j < draws.index.size(); ++j) draws.u(j, d) = all(draws.index[j], d);
}

} // namespace

int UnitDensity::dimensions() const {
    return std::visit([](const auto& density) { return density.dimensions(); }, density_);
}

void UnitDensity::draw(const PointBatch& v, UnitDraws& draws) const {
    std::visit([&](const auto& density) { draw_from(density, v, draws); }, density_);
}

void UnitDensity::pdf(const PointBatch& u, std::span<double> density) const {
    // The densities are defined inside.
    std::vector<std::size_t> inside;
    for (std::size_t i = 0; i < u.count(); ++i) {
        bool in = true;
        for (int d = 0; d < u.dimensions(); ++d) in = in && u(i, d) >= 0 && u(i, d) < 1;
        if (in) inside.push_back(i);
    }
    std::fill_n(density.begin(), u.count(), 0.0);
    PointBuffer points(inside.size(), u.dimensions());
    for (int d = 0; d < u.dimensions(); ++d)
        for (std::size_t j = 0; j < inside.size(); ++j) points(j, d) = u(inside[j], d);
    std::vector<double> p(inside.size(), 1.0);
    if (map() != nullptr) {
        PointBuffer y(inside.size(), u.dimensions());
        map()->inverse(points, y, p);
        for (double& value : p) value = 1 / value;
    } else {
        mixture()->pdf(points, p);
    }
    for (std::size_t j = 0; j < inside.size(); ++j) density[inside[j]] = p[j];
}

void UnitDensity::save(StateWriter& state) const {
    state.put(static_cast<std::uint64_t>(density_.index()));
    std::visit([&](const auto& density) { density.save(state); }, density_);
}

UnitDensity UnitDensity::load(StateReader& state, int dimensions) {
    const std::uint64_t kind = state.get_word();
    if (kind == 1) return MixtureDensity::load(state, dimensions);
    if (kind != 0) throw Error("holds a density of an unknown kind");
    AdaptiveMap map = AdaptiveMap::load(state);
    if (map.dimensions() != dimensions) throw Error("holds a map with another number of dimensions");
    return map;
}

} // namespace montelux
