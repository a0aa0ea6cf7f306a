#include "bench/rays/recorded_rays.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "montelux/render/sample_context.h"
#include "montelux/render/tile_renderer.h"

namespace montelux::bench {

std::string_view name_of(RayKind kind) {
    switch (kind) {
    case RayKind::camera:
        return "camera";
    case RayKind::bounce:
        return "bounce";
    case RayKind::shadow:
        break;
    }
    return "shadow";
}

std::string_view name_of(RayOrder order) {
    switch (order) {
    case RayOrder::path:
        return "path";
    case RayOrder::wave:
        return "wave";
    case RayOrder::sorted:
        break;
    }
    return "sorted";
}

RecordedRays::RecordedRays(const Renderer& renderer, std::uint32_t spp, std::size_t most) {
    SamplerSettings sampler = renderer.sampler();
    sampler.spp = spp;
    const SampleContext context(renderer.description(), sampler, renderer.scene(), renderer.camera());
    RayTracer tracer(renderer.accelerator());
    std::size_t sample = 0;
    for (const PixelBounds& tile : tiles_of(renderer.description().film.crop, 16))
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x)
                for (std::uint32_t i = 0; i < spp; ++i) {
                    add_path(context.record(tracer, {x, y, i}).path, sample++);
                    for (RayKind kind : ray_kinds)
                        if (count(kind) >= most) return;
                }
}

void RecordedRays::add_path(const PathRecord& path, std::size_t sample) {
    for (std::size_t depth = 0; depth < path.vertices.size(); ++depth) {
        const PathVertex& vertex = path.vertices[depth];
        rays(depth == 0 ? RayKind::camera : RayKind::bounce).push_back({vertex.ray, sample, depth});
        using Outcome = DirectLight::Outcome;
        if (vertex.direct &&
            (vertex.direct->outcome == Outcome::counted || vertex.direct->outcome == Outcome::occluded))
            rays(RayKind::shadow).push_back({vertex.direct->shadow, sample, depth});
    }
}

std::vector<Ray> RecordedRays::in_order(RayKind kind, RayOrder order) const {
    std::vector<Recorded> sequence = rays(kind);
    Bounds3 bounds;
    for (const Recorded& r : sequence) bounds.add(Vec3d(r.ray.o));
    const Vec3d extent = bounds.upper - bounds.lower;
    auto octant = [](Vec3f d) { return int{d.x < 0} | int{d.y < 0} << 1 | int{d.z < 0} << 2; };
    auto z_curve = [&](Point3f p) {
        constexpr int bits = 10;
        std::array<unsigned, 3> cell{};
        for (int axis = 0; axis < 3; ++axis)
            if (extent[axis] > 0)
                cell[static_cast<std::size_t>(axis)] = static_cast<unsigned>(
                    ((1 << bits) - 1) * (double(p[axis]) - bounds.lower[axis]) / extent[axis]);
        unsigned code = 0;
        for (unsigned bit = 0; bit < bits; ++bit)
            for (unsigned axis = 0; axis < 3; ++axis) code |= (cell[axis] >> bit & 1u) << (3 * bit + axis);
        return code;
    };
    if (order == RayOrder::wave)
        std::ranges::stable_sort(sequence, {},
                                 [](const Recorded& r) { return std::tuple(r.sample / batch, r.depth); });
    if (order == RayOrder::sorted)
        std::ranges::stable_sort(sequence, {}, [&](const Recorded& r) {
            return std::tuple(r.sample / batch, r.depth, octant(r.ray.d), z_curve(r.ray.o));
        });
    std::vector<Ray> result;
    result.reserve(sequence.size());
    for (const Recorded& r : sequence) result.push_back(r.ray);
    return result;
}

} // namespace montelux::bench
