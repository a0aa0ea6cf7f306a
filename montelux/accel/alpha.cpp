#include "montelux/accel/alpha.h"

#include <bit>
#include <cstdint>

#include "montelux/mc/random/hash.h"
#include "montelux/scene/shape/alpha.h"

namespace montelux {

bool is_opaque(const SceneView& scene, const Ray& ray, const Hit& hit) {
    // With instances, ray and shape are already in object space.
    const float alpha = alpha_at(scene, ray, hit);
    if (alpha >= 1) return true;
    if (!(alpha > 0)) return false;
    // Each surface along the ray decides independently; other geometry than triangles may be hit twice.
    std::uint64_t h = hash_key(hit.shape, hit.primitive);
    if (!std::holds_alternative<MeshIndex>(scene.shapes[hit.shape].geometry))
        h = mix64(h ^ std::bit_cast<std::uint32_t>(hit.t));
    for (float v : {ray.o.x, ray.o.y, ray.o.z, ray.d.x, ray.d.y, ray.d.z})
        h = mix64(h ^ std::bit_cast<std::uint32_t>(v));
    return static_cast<float>(h >> 40) * 0x1p-24f < alpha;
}

} // namespace montelux
