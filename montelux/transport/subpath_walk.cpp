#include "montelux/transport/subpath_walk.h"

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
        ray.o = offset_origin(s.p, s.ng, s.error, ray.d);
    }
    return false;
}

} // namespace

Index medium_at_light(const SceneView& scene, RayTracer& tracer, const Ray& light, bool at_infinity,
                      const Ray& camera) {
    if (scene.media.empty()) return no_index;
    Index medium = no_index;
    const auto separates = [&](const SurfacePoint& s) {
        if (!s.shape->media.is_transition()) return false;
        medium = medium_beyond(s, -light.d, no_index);
        return true;
    };
    if (!at_infinity && visit_surfaces(scene, tracer, light, separates)) return medium;
    // Around the scene, as seen from the camera.
    medium = scene.camera_medium;
    Ray out{camera.o, light.d};
    out.time = light.time;
    visit_surfaces(scene, tracer, out, [&](const SurfacePoint& s) {
        medium = medium_beyond(s, out.d, medium);
        return false;
    });
    return medium;
}

} // namespace montelux
