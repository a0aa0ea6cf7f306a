#include "montelux/transport/subpath.h"

#include <variant>

#include "montelux/transport/texture_footprint.h"

namespace montelux {

namespace {

SubpathVertex& add_end(std::vector<SubpathVertex>& path, SubpathEnd& end, float more) {
    SubpathVertex& v = path.emplace_back();
    v.throughput = end.throughput;
    v.lambda = end.lambda;
    v.edge = end.edge;
    v.medium = end.medium;
    v.w = end.ray.d;
    const float distance = end.distance + more;
    v.distance2 = distance * distance;
    v.events = ++end.events;
    end.edge = {};
    end.distance = 0;
    return v;
}

} // namespace

SubpathVertex& add_vertex(std::vector<SubpathVertex>& path, SubpathEnd& end, Point3f p,
                          const PhaseFunction& phase) {
    SubpathVertex& v = add_end(path, end, length(p - end.ray.o));
    v.s.p = p;
    v.phase = &phase;
    v.wo = -v.w;
    v.connectible = true;
    return v;
}

SubpathVertex& add_vertex(std::vector<SubpathVertex>& path, const SceneView& scene, SubpathEnd& end,
                          const Hit& hit) {
    const Index material = scene.shapes[hit.shape].material;
    const SurfacePoint s = surface_point(
        scene, end.ray, hit, scene.is_textured(material) || scene.frame_follows_tangents(material));
    SubpathVertex& v = add_end(path, end, hit.t);
    v.s = s;
    return v;
}

bool make_scattering(const SceneView& scene, const Camera& camera, float footprint_scale, SubpathVertex& v,
                     SubpathEnd& end) {
    const TextureContext context = scene.is_textured(v.s.shape->material)
                                       ? texture_context(camera, footprint_scale, v.s)
                                       : TextureContext();
    const bool was_terminated = end.lambda.secondary_terminated();
    v.surface = make_bsdf(scene, v.s, -v.w, context, end.lambda);
    if (!was_terminated && end.lambda.secondary_terminated()) end.terminate_secondary();
    v.lambda = end.lambda;
    v.wo = v.surface.frame.to_local(-v.w);
    v.connectible = v.wo.z != 0 && !is_specular(v.surface.bsdf);
    return v.wo.z != 0;
}

} // namespace montelux
