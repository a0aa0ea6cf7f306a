#include "montelux/accel/accelerator.h"

#include <algorithm>

#include "montelux/accel/embree_scene.h"
#include "montelux/accel/packets.h"

namespace montelux {

namespace {

constexpr std::size_t closest_width = 8, any_width = 16; // the fastest ones (docs/measurements/rays.md)

// False for a miss.
bool to_hit(const SceneView& scene, const BareHit& bare, Hit& hit) {
    if (bare.shape == RTC_INVALID_GEOMETRY_ID) return false;
    hit.t = bare.t;
    hit.b1 = bare.u;
    hit.b2 = bare.v;
    hit.primitive = bare.primitive;
    if (bare.instance == RTC_INVALID_GEOMETRY_ID) {
        hit.instance = no_index;
        hit.shape = scene.world_shapes[bare.shape];
    } else {
        hit.instance = bare.instance - static_cast<Index>(scene.world_shapes.size());
        hit.shape = scene.objects[scene.instances[hit.instance].object].shapes[bare.shape];
    }
    return true;
}

// Calls f with packets of at most K consecutive rays, and the index of the first.
template <std::size_t K, typename F>
void for_packets(std::span<const Ray* const> rays, const F& f) {
    for (std::size_t first = 0; first < rays.size(); first += K)
        f(rays.subspan(first, std::min(K, rays.size() - first)), first);
}

} // namespace

Accelerator::Accelerator(const SceneView& scene) : scene_(std::make_unique<EmbreeScene>(scene)) {}
Accelerator::~Accelerator() = default;
Accelerator::Accelerator(Accelerator&&) noexcept = default;
Accelerator& Accelerator::operator=(Accelerator&&) noexcept = default;

std::size_t Accelerator::bytes() const { return scene_->bytes(); }
const Bounds3& Accelerator::bounds() const { return scene_->bounds(); }

// For moving instances Embree rounds otherwise in a packet than alone, and for meshes that deform it promises nothing:
// there a ray alone is a packet with one ray, so that replays have the same bits.
bool Accelerator::intersect(const Ray& ray, Hit& hit) const {
    if (scene_->moves()) {
        const Ray* one = &ray;
        intersect(std::span(&one, 1), std::span(&hit, 1));
        return hit.shape != no_index;
    }
    QueryContext context;
    Packet<1> r(ray);
    r.closest(scene_->world(), context);
    return to_hit(scene_->scene(), r.hit(), hit);
}

bool Accelerator::occluded(const Ray& ray) const {
    if (scene_->moves()) {
        const Ray* one = &ray;
        bool result = false;
        occluded(std::span(&one, 1), std::span(&result, 1));
        return result;
    }
    QueryContext context;
    Packet<1> r(ray);
    r.any(scene_->world(), context);
    return r.embree.ray.tfar < 0;
}

void Accelerator::intersect(std::span<const Ray* const> rays, std::span<Hit> hits) const {
    QueryContext context;
    for_packets<closest_width>(rays, [&](std::span<const Ray* const> some, std::size_t first) {
        Packet<closest_width> packet(some);
        packet.closest(scene_->world(), context);
        for (std::size_t i = 0; i < some.size(); ++i)
            if (!to_hit(scene_->scene(), packet.hit(i), hits[first + i])) hits[first + i].shape = no_index;
    });
}

void Accelerator::occluded(std::span<const Ray* const> rays, std::span<bool> results) const {
    QueryContext context;
    for_packets<any_width>(rays, [&](std::span<const Ray* const> some, std::size_t first) {
        Packet<any_width> packet(some);
        packet.any(scene_->world(), context);
        for (std::size_t i = 0; i < some.size(); ++i) results[first + i] = packet.embree.ray.tfar[i] < 0;
    });
}

} // namespace montelux
