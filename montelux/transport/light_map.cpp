#include "montelux/transport/light_map.h"

#include <bit>
#include <numbers>
#include <numeric>

#include "montelux/mc/random/hash.h"

namespace montelux {

LightMap::LightMap(std::vector<LightPaths> parts, std::uint64_t paths, double radius)
    : parts_(std::move(parts)), paths_(paths), radius_(radius),
      area_paths_(std::numbers::pi * radius * radius * static_cast<double>(paths)) {
    std::size_t count = 0;
    for (const LightPaths& part : parts_)
        count += static_cast<std::size_t>(
            std::ranges::count_if(part.vertices, [](const LightMapVertex& v) { return v.mergeable; }));
    mask_ = static_cast<std::uint32_t>(std::bit_ceil(std::max<std::size_t>(count, 1)) - 1);
    first_.assign(std::size_t{mask_} + 2, 0);
    const auto for_all = [&](const auto& f) {
        for (std::uint32_t i = 0; i < parts_.size(); ++i)
            for (std::uint32_t j = 0; j < parts_[i].vertices.size(); ++j)
                if (const LightMapVertex& v = parts_[i].vertices[j]; v.mergeable) f(v, i, j);
    };
    for_all([&](const LightMapVertex& v, std::uint32_t, std::uint32_t) { ++first_[slot_at(v.p)]; });
    // From the ends of the slots down to their beginnings, the last vertices first: those of a slot keep their order.
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    entries_.resize(count);
    for (auto i = static_cast<std::uint32_t>(parts_.size()); i-- > 0;)
        for (auto j = static_cast<std::uint32_t>(parts_[i].vertices.size()); j-- > 0;)
            if (const LightMapVertex& v = parts_[i].vertices[j]; v.mergeable)
                entries_[--first_[slot_at(v.p)]] = {v.p, i, j};
}

std::size_t LightMap::bytes() const {
    std::size_t sum = first_.size() * sizeof(std::uint32_t) + entries_.size() * sizeof(Entry);
    for (const LightPaths& part : parts_) sum += part.bytes();
    return sum;
}

std::int64_t LightMap::cell(double coordinate) const {
    // A little wider: rounding must not spread a ball over three cells.
    const double width = 2.0001 * radius_;
    return static_cast<std::int64_t>(std::clamp(std::floor(coordinate / width), -0x1p60, 0x1p60));
}

std::uint32_t LightMap::slot(const Cell& cell) const {
    return static_cast<std::uint32_t>(hash_key(static_cast<std::uint64_t>(cell[0]),
                                               static_cast<std::uint64_t>(cell[1]),
                                               static_cast<std::uint64_t>(cell[2]))) &
           mask_;
}

std::size_t LightMap::slots_around(Point3f p, std::array<std::uint32_t, 8>& slots) const {
    Cell low, high;
    for (int i = 0; i < 3; ++i) {
        const auto axis = static_cast<std::size_t>(i);
        low[axis] = cell(double(p[i]) - radius_);
        // Coordinates next to p may lie further away than a tiny radius.
        high[axis] = std::min(cell(double(p[i]) + radius_), low[axis] + 1);
    }
    std::size_t count = 0;
    Cell at;
    for (at[0] = low[0]; at[0] <= high[0]; ++at[0])
        for (at[1] = low[1]; at[1] <= high[1]; ++at[1])
            for (at[2] = low[2]; at[2] <= high[2]; ++at[2]) {
                const std::uint32_t s = slot(at);
                if (std::find(slots.begin(), slots.begin() + count, s) == slots.begin() + count)
                    slots[count++] = s;
            }
    return count;
}

} // namespace montelux
