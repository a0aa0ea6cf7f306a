// LightMap: the vertices of many light paths, to be found by their place.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/math/vec.h"
#include "montelux/spectrum/sampled_spectrum.h"
#include "montelux/transport/edge_density.h"

namespace montelux {

// What merging needs of a vertex of a light's path: SubpathVertex says what the members are. The vertices of a path lie
// one after the other, from y_1 on.
struct LightMapVertex {
    SampledSpectrum throughput;
    Point3f p;
    Vec3f w;
    Normal3f ng;
    float forward = 0, backward = 0;
    // Times a density of directions at this vertex: that of the vertex before, as `backward`. 0 of lights that no ray
    // hits.
    float to_previous = 0;
    float emission = 0, next_event = 0; // PathDensities::from_light[0] and next_event, of the path
    std::uint32_t number = 0;           // in the path, from 1
    std::int32_t events = 0;
    bool delta = false, in_medium = false;
    bool terminated = false; // the first wavelength stands for all
    bool mergeable = false;

    // Vertex i of the path, up to this one.
    const LightMapVertex& at(std::size_t i) const { return *(this - (number - i)); }
};

// Some light paths, in their order.
struct LightPaths {
    std::vector<LightMapVertex> vertices;
    std::vector<EdgeDensity> edges; // to each of the vertices; empty without media

    std::size_t bytes() const {
        return vertices.size() * sizeof(LightMapVertex) + edges.size() * sizeof(EdgeDensity);
    }
    // Of a vertex and those before it.
    const EdgeDensity& edge(const LightMapVertex& v) const {
        return edges[static_cast<std::size_t>(&v - vertices.data())];
    }
};

// A hash grid of cells a little wider than the balls in which vertices merge. Vertices are visited in an order that
// depends on the light paths alone.
class LightMap {
  public:
    // `paths`: how many there are, with those that found nothing. The radius must be positive.
    LightMap(std::vector<LightPaths> parts, std::uint64_t paths, double radius);

    double radius() const { return radius_; }
    std::uint64_t paths() const { return paths_; }
    // pi r^2 N: what a density per area is multiplied by.
    double area_paths() const { return area_paths_; }
    std::span<const LightPaths> parts() const { return parts_; }
    std::size_t bytes() const;
    bool empty() const { return entries_.empty(); } // nothing merges
    // Of a map, per mergeable vertex beside LightPaths::bytes().
    static constexpr std::size_t bytes_per_entry = 32;

    // Calls visit(vertex, its LightPaths, squared distance) for the mergeable vertices within the radius.
    template <typename Visit>
    void visit(Point3f p, const Visit& visit) const {
        std::array<std::uint32_t, 8> slots;
        const std::size_t count = slots_around(p, slots);
        const auto most = static_cast<float>(radius_ * radius_);
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t end = first_[slots[i] + 1];
            for (std::uint32_t e = first_[slots[i]]; e < end; ++e) {
                const Entry& entry = entries_[e];
                const float distance2 = length_squared(entry.p - p);
                if (!(distance2 < most)) continue;
                const LightPaths& part = parts_[entry.part];
                visit(part.vertices[entry.vertex], part, distance2);
            }
        }
    }

  private:
    struct Entry {
        Point3f p;
        std::uint32_t part = 0, vertex = 0;
    };
    using Cell = std::array<std::int64_t, 3>;

    std::int64_t cell(double coordinate) const;
    std::uint32_t slot(const Cell& cell) const;
    std::uint32_t slot_at(Point3f p) const { return slot(Cell{cell(p.x), cell(p.y), cell(p.z)}); }
    // Of all cells that the ball around p reaches, each once; returns how many.
    std::size_t slots_around(Point3f p, std::array<std::uint32_t, 8>& slots) const;

    std::vector<LightPaths> parts_;
    std::uint64_t paths_;
    double radius_, area_paths_;
    std::uint32_t mask_ = 0;
    std::vector<std::uint32_t> first_; // entry of each slot, and the end
    std::vector<Entry> entries_;
};

} // namespace montelux
