#include "montelux/accel/accelerator.h"

#include "montelux/accel/embree_scene.h"

namespace montelux {

namespace {

RTCRay embree_ray(const Ray& ray) {
    return {.org_x = ray.o.x,
            .org_y = ray.o.y,
            .org_z = ray.o.z,
            .tnear = 0,
            .dir_x = ray.d.x,
            .dir_y = ray.d.y,
            .dir_z = ray.d.z,
            .time = 0,
            .tfar = ray.t_max,
            .mask = ~0u,
            .id = 0,
            .flags = 0};
}

} // namespace

Accelerator::Accelerator(const SceneView& scene) : scene_(std::make_unique<EmbreeScene>(scene)) {}
Accelerator::~Accelerator() = default;
Accelerator::Accelerator(Accelerator&&) noexcept = default;
Accelerator& Accelerator::operator=(Accelerator&&) noexcept = default;

const Bounds3& Accelerator::bounds() const { return scene_->bounds(); }

bool Accelerator::intersect(const Ray& ray, Hit& hit) const {
    RTCRayHit r;
    r.ray = embree_ray(ray);
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    closest_hit(scene_->world(), r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    hit.t = r.ray.tfar;
    hit.b1 = r.hit.u;
    hit.b2 = r.hit.v;
    hit.primitive = r.hit.primID;
    const SceneView& scene = scene_->scene();
    if (r.hit.instID[0] == RTC_INVALID_GEOMETRY_ID) {
        hit.instance = no_index;
        hit.shape = scene.world_shapes[r.hit.geomID];
    } else {
        hit.instance = r.hit.instID[0] - static_cast<Index>(scene.world_shapes.size());
        hit.shape = scene.objects[scene.instances[hit.instance].object].shapes[r.hit.geomID];
    }
    return true;
}

bool Accelerator::occluded(const Ray& ray) const {
    RTCRay r = embree_ray(ray);
    any_hit(scene_->world(), r);
    return r.tfar < 0;
}

} // namespace montelux
