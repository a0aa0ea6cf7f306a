#include "montelux/transport/subpath.h"

#include <variant>

#include "montelux/transport/texture_footprint.h"

namespace montelux {

SubpathVertex& add_vertex(std::vector<SubpathVertex>& path, const SceneView& scene, const Ray& ray,
                          const Hit& hit, SampledSpectrum throughput) {
    SubpathVertex& v = path.emplace_back();
    const Index material = scene.shapes[hit.shape].material;
    v.s =
        surface_point(scene, ray, hit, scene.is_textured(material) || scene.frame_follows_tangents(material));
    v.throughput = throughput;
    v.w = ray.d;
    v.distance2 = hit.t * hit.t;
    return v;
}

bool make_scattering(const SceneView& scene, const Camera& camera, float footprint_scale, SubpathVertex& v,
                     SampledWavelengths& lambda) {
    const TextureContext context = scene.is_textured(v.s.shape->material)
                                       ? texture_context(camera, footprint_scale, v.s)
                                       : TextureContext();
    v.surface = make_bsdf(scene, v.s, -v.w, context, lambda);
    v.lambda = lambda;
    v.wo = v.surface.frame.to_local(-v.w);
    v.connectible = v.wo.z != 0 && !std::visit([](const auto& b) { return b.is_specular(); }, v.surface.bsdf);
    return v.wo.z != 0;
}

} // namespace montelux
