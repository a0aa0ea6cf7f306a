#include "montelux/scene/shape/alpha.h"

#include "montelux/scene/shape/surface_point.h"
#include "montelux/scene/texture/evaluate.h"

namespace montelux {

bool is_cut_out(const Shape& shape) { return !shape.alpha.is_constant() || shape.alpha.value < 1; }

std::optional<float> constant_alpha(const SceneView& scene, const Shape& shape) {
    const FloatParameter* p = &shape.alpha;
    while (!p->is_constant()) {
        const auto* texture = std::get_if<ConstantTexture<FloatParameter>>(&scene.float_textures[p->texture]);
        if (texture == nullptr) return std::nullopt;
        p = &texture->value;
    }
    return p->value;
}

float alpha_at(const SceneView& scene, const Ray& ray, const Hit& hit) {
    const SurfacePoint s = surface_point(scene, ray, hit, true);
    const TextureContext context{.p = s.p,
                                 .n = s.ns,
                                 .uv = s.uv,
                                 .dpdx = {},
                                 .dpdy = {},
                                 .duvdx = {},
                                 .duvdy = {},
                                 .vertex_color = s.vertex_color,
                                 .vertex_opacity = s.vertex_opacity,
                                 .second_uv = s.second_uv};
    return evaluate(scene, scene.shapes[hit.shape].alpha, context);
}

} // namespace montelux
