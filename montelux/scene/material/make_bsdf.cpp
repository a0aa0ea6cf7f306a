#include "montelux/scene/material/make_bsdf.h"

#include "montelux/scene/material/parameter_evaluator.h"
#include "montelux/scene/material/shading_frame.h"

namespace montelux {

namespace {

Frame plain_frame(const SceneView& scene, const SurfacePoint& surface) {
    return scene.frame_follows_tangents(surface.shape->material)
               ? Frame::from_normal_and_tangent(surface.ns, surface.dpdu)
               : Frame::from_normal(surface.ns);
}

// `normal`: the geometric normal in the frame of the BSDF.
Bsdf tilted(const Bsdf& bsdf, Normal3f normal) {
    return std::visit(
        [&]<typename B>(const B& b) -> Bsdf {
            if constexpr (std::is_constructible_v<UntiltedBsdf, B>)
                return TiltedBsdf{b, normal};
            else
                return b; // already tilted
        },
        bsdf);
}

} // namespace

SurfaceBsdf make_bsdf(const SceneView& scene, const SurfacePoint& surface, Vec3f wo,
                      const TextureContext& context, SampledWavelengths& lambda) {
    const Index index = surface.shape->material;
    const ParameterEvaluator at(scene, index, context, lambda);
    return std::visit(
        [&](const auto& m) -> SurfaceBsdf {
            if (!m.detail.is_flat())
                if (auto frame = tilted_frame(scene, m.detail, surface, wo, context))
                    return {tilted(m.bsdf(at), frame->to_local(surface.ng)), *frame};
            return {m.bsdf(at), plain_frame(scene, surface)};
        },
        scene.materials[index]);
}

} // namespace montelux
