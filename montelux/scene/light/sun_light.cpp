#include "montelux/scene/light/sun_light.h"

#include <algorithm>
#include <cmath>

#include "montelux/scene/light/light_context.h"
#include "montelux/scene/light/scene_disk.h"
#include "montelux/scene/light/shadow_ray.h"
#include "montelux/scene/light/visible_mean.h"

namespace montelux {

SunLight SunLight::moved(const Transform& world_from_own) const {
    SunLight light = *this;
    light.disc.centre = normalize(world_from_own.vector(disc.centre));
    light.up = normalize(world_from_own.normal(up));
    light.motion = no_index;
    return light;
}

Index SunLight::part_count(const LightContext&) const { return 1; }

std::optional<LightSample> SunLight::sample_li(const LightContext& context, Index, const ReferencePoint& from,
                                               Vec2f u, const SampledWavelengths& lambda) const {
    const Vec3f wi = disc.sample(u);
    if (hides(wi)) return std::nullopt;
    return LightSample{.radiance = context.scene.sample(spectrum, lambda) * scale,
                       .wi = wi,
                       .pdf = disc.pdf(),
                       .shadow = shadow_ray_to_infinity(from, wi)};
}

float SunLight::pdf_li(const LightContext&, const ReferencePoint&, const LightHit& hit) const {
    return disc.contains(hit.wi) ? disc.pdf() : 0;
}

SampledSpectrum SunLight::radiance(const LightContext& context, const ReferencePoint&, const LightHit& hit,
                                   const SampledWavelengths& lambda) const {
    if (!disc.contains(hit.wi) || hides(hit.wi)) return {};
    return context.scene.sample(spectrum, lambda) * scale;
}

std::optional<EmissionSample> SunLight::sample_le(const LightContext& context, Index, Vec2f u_position,
                                                  Vec2f u_direction, const SampledWavelengths& lambda) const {
    const Vec3f wi = disc.sample(u_direction);
    if (hides(wi)) return std::nullopt;
    const SceneDisk disk(context.tables().scene_bounds);
    EmissionSample s;
    s.radiance = context.scene.sample(spectrum, lambda) * scale;
    s.ray = disk.sample(-wi, u_position);
    s.pdf_position = disk.pdf();
    s.pdf_direction = disc.pdf();
    return s;
}

EmissionPdf SunLight::pdf_le(const LightContext& context, const LightHit&, Vec3f w) const {
    if (!disc.contains(-w) || hides(-w)) return {};
    return {SceneDisk(context.tables().scene_bounds).pdf(), disc.pdf()};
}

void SunLight::powers(const LightContext& context, std::span<double> parts) const {
    const double above = std::asin(std::clamp(double(dot(disc.centre, up)), -1.0, 1.0));
    parts[0] = SceneDisk(context.tables().scene_bounds).area() * double(scale) *
               visible_mean(context.scene.spectrum(spectrum)) * disc.solid_angle() *
               part_above_horizon(above, std::sqrt(2 * double(disc.versine)));
}

std::optional<LightBounds> SunLight::bounds(const LightContext&, Index) const { return std::nullopt; }

} // namespace montelux
