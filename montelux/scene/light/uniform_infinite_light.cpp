#include "montelux/scene/light/uniform_infinite_light.h"

#include <algorithm>

#include "montelux/mc/math/frame.h"
#include "montelux/mc/warp/hemisphere.h"
#include "montelux/mc/warp/sphere.h"
#include "montelux/scene/light/light_context.h"
#include "montelux/scene/light/scene_disk.h"
#include "montelux/scene/light/shadow_ray.h"
#include "montelux/scene/light/visible_mean.h"

namespace montelux {

Index UniformInfiniteLight::part_count(const LightContext&) const { return 1; }

std::optional<LightSample> UniformInfiniteLight::sample_li(const LightContext& context, Index,
                                                           const ReferencePoint& from, Vec2f u,
                                                           const SampledWavelengths& lambda) const {
    LightSample s;
    if (portal) {
        const auto seen = portal->seen_from(from.p);
        if (!seen) return std::nullopt;
        s.wi = seen->sample(u);
        s.pdf = seen->pdf();
    } else {
        s.wi = sample_uniform_sphere(u);
        s.pdf = inv_four_pi_f;
    }
    s.radiance = context.scene.sample(spectrum, lambda) * scale;
    s.shadow = shadow_ray_to_infinity(from, s.wi);
    return s;
}

float UniformInfiniteLight::pdf_li(const LightContext&, const ReferencePoint& from,
                                   const LightHit& hit) const {
    if (!portal) return inv_four_pi_f;
    if (!portal->lets_through(from.p, hit.wi)) return 0;
    const auto seen = portal->seen_from(from.p);
    return seen ? seen->pdf() : 0;
}

SampledSpectrum UniformInfiniteLight::radiance(const LightContext& context, const ReferencePoint& from,
                                               const LightHit& hit, const SampledWavelengths& lambda) const {
    if (portal && !portal->lets_through(from.p, hit.wi)) return {};
    return context.scene.sample(spectrum, lambda) * scale;
}

std::optional<EmissionSample> UniformInfiniteLight::sample_le(const LightContext& context, Index,
                                                              Vec2f u_position, Vec2f u_direction,
                                                              const SampledWavelengths& lambda) const {
    const SceneDisk disk(context.tables().scene_bounds);
    EmissionSample s;
    if (portal) {
        // Uniform over the portal, directions by the cosine: the flux of every sample is the same.
        const Vec3f local = sample_cosine_hemisphere(u_direction);
        if (!(local.z > 0)) return std::nullopt;
        const Vec3f w = -normalize(Vec3f(portal->to_world(Vec3d(local))));
        s.ray = disk.through(portal->point(Vec2d(u_position)), w);
        s.pdf_position = static_cast<float>(1 / (portal->area() * double(local.z)));
        s.pdf_direction = cosine_hemisphere_pdf(local.z);
    } else {
        s.ray = disk.sample(-sample_uniform_sphere(u_direction), u_position);
        s.pdf_position = disk.pdf();
        s.pdf_direction = inv_four_pi_f;
    }
    s.radiance = context.scene.sample(spectrum, lambda) * scale;
    return s;
}

EmissionPdf UniformInfiniteLight::pdf_le(const LightContext& context, const LightHit&, Vec3f w) const {
    if (!portal) return {SceneDisk(context.tables().scene_bounds).pdf(), inv_four_pi_f};
    const double cosine = portal->to_local(-Vec3d(w)).z;
    if (!(cosine > 0)) return {};
    return {static_cast<float>(1 / (portal->area() * cosine)),
            cosine_hemisphere_pdf(static_cast<float>(cosine))};
}

void UniformInfiniteLight::powers(const LightContext& context, std::span<double> parts) const {
    const double cross_section = SceneDisk(context.tables().scene_bounds).area();
    const double flux = double(scale) * visible_mean(context.scene.spectrum(spectrum));
    parts[0] =
        portal ? flux * std::min(pi * portal->area(), 2 * pi * cross_section) : 4 * pi * cross_section * flux;
}

std::optional<LightBounds> UniformInfiniteLight::bounds(const LightContext&, Index) const {
    return std::nullopt;
}

} // namespace montelux
