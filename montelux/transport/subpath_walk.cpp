#include "montelux/transport/subpath_walk.h"

#include <algorithm>

namespace montelux {

namespace {

// Calls visit(surface) for the surfaces along a ray until that returns true.
template <typename Visit>
bool visit_surfaces(const SceneView& scene, RayTracer& tracer, Ray ray, const Visit& visit) {
    for (int i = 0; i < most_interfaces; ++i) {
        Hit hit;
        if (!tracer.intersect(ray, hit)) return false;
        const SurfacePoint s = surface_point(scene, ray, hit, false);
        if (visit(s)) return true;
        const Point3f from = offset_origin(s.p, s.ng, s.error, ray.d);
        ray.t_max -= length(from - ray.o);
        if (!(ray.t_max > 0)) return false;
        ray.o = from;
    }
    return false;
}

} // namespace

Index medium_at_light(const SceneView& scene, RayTracer& tracer, const Ray& light, const Ray& camera) {
    if (scene.media.empty()) return no_index;
    Index medium = no_index;
    const auto separates = [&](const SurfacePoint& s) {
        if (!s.shape->media.is_transition()) return false;
        medium = medium_beyond(s, -light.d, no_index);
        return true;
    };
    if (visit_surfaces(scene, tracer, light, separates)) return medium;
    // All of the ray lies in one medium. A point of it is reached from the camera, whose medium is known: off the light,
    // whose own surface may separate media, and before the first surface, beyond which the way may lead past them.
    medium = scene.camera_medium;
    Hit hit;
    const float distance =
        tracer.intersect(light, hit) ? hit.t / 2 : std::max(length(light.o - camera.o), 1e-3f);
    const Vec3f way = light.o + light.d * distance - camera.o;
    const float far = length(way);
    if (!(far > 0)) return medium;
    Ray out{camera.o, way / far, far};
    out.time = light.time;
    visit_surfaces(scene, tracer, out, [&](const SurfacePoint& s) {
        medium = medium_beyond(s, out.d, medium);
        return false;
    });
    return medium;
}

} // namespace montelux
