#include "montelux/scene/material/make_bsdf.h"

#include <algorithm>
#include <optional>
#include <type_traits>

#include "montelux/scene/bsdf/multiple_scattering.h"
#include "montelux/scene/material/parameter_evaluator.h"
#include "montelux/scene/material/shading_frame.h"

namespace montelux {

namespace {

// The material at a point, or no_index for black: mixes and sides choose one of theirs. Scenes without cycles end this
// (check_references.h).
Index material_at(const SceneView& scene, const SurfacePoint& surface, Vec3f wo,
                  const TextureContext& context) {
    Index index = surface.shape->material;
    while (index != no_index) {
        const Material& material = scene.materials[index];
        if (const auto* mix = std::get_if<MixMaterial>(&material))
            index = mix->choose(evaluate(scene, mix->amount, context), surface.p, wo, index);
        else if (const auto* sided = std::get_if<SidedMaterial>(&material))
            index = sided->side(dot(wo, surface.ng) > 0);
        else
            break;
    }
    return index;
}

Frame plain_frame(const SceneView& scene, Index material, const SurfacePoint& surface) {
    return scene.frame_follows_tangents(material)
               ? Frame::from_normal_and_tangent(surface.ns, surface.tangent())
               : Frame::from_normal(surface.ns);
}

// The roughness, squared, of microfacets that are on average as steep as a normal at this angle from +z: equation 4 of
// Estevez, Lecocq, Stein 2019, which takes a quarter of the steepest ones' tangent for the variance.
float shadowing_of(Normal3f normal) {
    const float cos2 = normal.z * normal.z;
    return std::min(0.125f * std::max(1 - cos2, 0.0f) / cos2, 1.0f);
}

// `normal`: the normal that decides on sides, in the frame of the BSDF.
Bsdf tilted(const Bsdf& bsdf, Normal3f normal, float shadowing) {
    return std::visit(
        [&]<typename B>(const B& b) -> Bsdf {
            if constexpr (std::is_constructible_v<UntiltedBsdf, B>)
                return TiltedBsdf{b, normal, shadowing};
            else
                return b; // already tilted
        },
        bsdf);
}

// A coat has normals of its own.
void tilt_coat(const SceneView& scene, const PrincipledMaterial& material, const SurfacePoint& surface,
               Vec3f wo, const TextureContext& context, const Frame& frame, Bsdf& bsdf) {
    if (!material.has_coat()) return;
    const SurfaceDetail detail{.normal_map = material.clearcoat_normal_map};
    const std::optional<Frame> own =
        detail.is_flat() ? std::nullopt : tilted_frame(scene, detail, surface, wo, context);
    const Normal3f normal = own ? own->n : surface.ns;
    if (normal == frame.n) return;
    std::visit(
        [&]<typename B>(B& b) {
            if constexpr (requires { b.layers.set_coat_normal(normal); })
                b.layers.set_coat_normal(frame.to_local(normal));
        },
        bsdf);
}

// As the material describes it: with single scattering between microfacets.
SurfaceBsdf plain_bsdf(const SceneView& scene, const SurfacePoint& surface, Vec3f wo,
                       const TextureContext& context, SampledWavelengths& lambda, bool widen) {
    const Index index = material_at(scene, surface, wo, context);
    if (index == no_index) return {DiffuseBsdf{SampledSpectrum(0)}, Frame::from_normal(surface.ns)};
    const ParameterEvaluator at(scene, index, context, lambda, widen);
    return std::visit(
        [&]<typename M>(const M& m) -> SurfaceBsdf {
            constexpr bool has_own_coat = std::is_same_v<M, PrincipledMaterial>;
            if (!m.detail.is_flat())
                if (auto frame = tilted_frame(scene, m.detail, surface, wo, context)) {
                    const Normal3f normal = frame->to_local(m.detail.shadowed ? surface.ns : surface.ng);
                    Bsdf bsdf = m.bsdf(at);
                    if constexpr (has_own_coat) tilt_coat(scene, m, surface, wo, context, *frame, bsdf);
                    return {tilted(bsdf, normal, m.detail.shadowed ? shadowing_of(normal) : 0), *frame};
                }
            SurfaceBsdf plain{m.bsdf(at), plain_frame(scene, index, surface)};
            if constexpr (has_own_coat) tilt_coat(scene, m, surface, wo, context, plain.frame, plain.bsdf);
            return plain;
        },
        scene.materials[index]);
}

} // namespace

SurfaceBsdf make_bsdf(const SceneView& scene, const SurfacePoint& surface, Vec3f wo,
                      const TextureContext& context, SampledWavelengths& lambda, bool widen) {
    SurfaceBsdf made = plain_bsdf(scene, surface, wo, context, lambda, widen);
    if (scene.multiple_scattering) [[unlikely]]
        made.bsdf = with_multiple_scattering(made.bsdf);
    return made;
}

} // namespace montelux
