#include "montelux/scene/material/make_bsdf.h"

#include "montelux/scene/material/parameter_evaluator.h"
#include "montelux/scene/material/shading_frame.h"

namespace montelux {

namespace {

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
    const Frame plain = scene.frame_follows_tangents(index)
                            ? Frame::from_normal_and_tangent(surface.ns, surface.dpdu)
                            : Frame::from_normal(surface.ns);
    return std::visit(
        [&](const auto& m) -> SurfaceBsdf {
            SurfaceBsdf made{m.bsdf(at), plain};
            if (m.detail.is_flat()) return made;
            if (auto frame = tilted_frame(scene, m.detail, surface, wo, context))
                made = {tilted(made.bsdf, frame->to_local(surface.ng)), *frame};
            return made;
        },
        scene.materials[index]);
}

} // namespace montelux
