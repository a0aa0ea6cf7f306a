// RecordedRays: the rays that a render traces, by kind and in several orders.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "montelux/render/renderer.h"
#include "montelux/transport/path_record.h"

namespace montelux::bench {

enum class RayKind : unsigned char { camera, bounce, shadow };
inline constexpr std::array<RayKind, 3> ray_kinds{RayKind::camera, RayKind::bounce, RayKind::shadow};
std::string_view name_of(RayKind kind);

enum class RayOrder : unsigned char {
    path,   // sample by sample, along each path
    wave,   // of a batch of samples all rays of depth 1, then of depth 2, ...
    sorted, // as wave; each depth by the octant of the direction, then along a Z curve of the origins
};
inline constexpr std::array<RayOrder, 3> ray_orders{RayOrder::path, RayOrder::wave, RayOrder::sorted};
std::string_view name_of(RayOrder order);

class RecordedRays {
  public:
    // Samples per batch of the orders wave and sorted.
    static constexpr std::size_t batch = 1024;

    // Of all pixels, tile by tile, until one kind has `most` rays or all samples are taken.
    RecordedRays(const Renderer& renderer, std::uint32_t spp, std::size_t most);

    std::vector<Ray> in_order(RayKind kind, RayOrder order) const;
    std::size_t count(RayKind kind) const { return rays(kind).size(); }

  private:
    struct Recorded {
        Ray ray;
        std::size_t sample = 0;
        std::size_t depth = 0;
    };
    std::vector<Recorded>& rays(RayKind kind) { return rays_[static_cast<std::size_t>(kind)]; }
    const std::vector<Recorded>& rays(RayKind kind) const { return rays_[static_cast<std::size_t>(kind)]; }
    void add_path(const PathRecord& path, std::size_t sample);

    std::array<std::vector<Recorded>, ray_kinds.size()> rays_;
};

} // namespace montelux::bench
