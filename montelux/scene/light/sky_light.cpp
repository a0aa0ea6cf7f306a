#include "montelux/scene/light/sky_light.h"

#include "montelux/scene/light/light_context.h"
#include "montelux/scene/light/scene_disk.h"
#include "montelux/scene/light/shadow_ray.h"
#include "montelux/scene/light/turned_map.h"

namespace montelux {

namespace {

TurnedMap turned_map(const LightContext& context, const SkyLight& light) {
    return {context.tables().environment(context.light), light.world_from_light};
}

// Of a place on the map, or of a direction in the light's space.
SampledSpectrum radiance_at(const LightContext& context, const SkyLight& light, Vec3f w,
                            const SampledWavelengths& lambda) {
    return context.scene.skies[light.sky].radiance(w, lambda) * light.scale;
}

} // namespace

SkyLight SkyLight::moved(const Transform& world_from_own) const {
    SkyLight light = *this;
    light.world_from_light = world_from_own * world_from_light;
    light.motion = no_index;
    return light;
}

Index SkyLight::part_count(const LightContext&) const { return 1; }

std::optional<LightSample> SkyLight::sample_li(const LightContext& context, Index, const ReferencePoint& from,
                                               Vec2f u, const SampledWavelengths& lambda) const {
    const TurnedMap map = turned_map(context, *this);
    const auto s = map.sample(u);
    if (!s) return std::nullopt;
    return LightSample{.radiance = radiance_at(context, *this, map.map.grid().direction(s->grid), lambda),
                       .wi = s->wi,
                       .pdf = s->pdf,
                       .shadow = shadow_ray_to_infinity(from, s->wi)};
}

float SkyLight::pdf_li(const LightContext& context, const ReferencePoint&, const LightHit& hit) const {
    return turned_map(context, *this).pdf(hit.wi);
}

SampledSpectrum SkyLight::radiance(const LightContext& context, const ReferencePoint&, const LightHit& hit,
                                   const SampledWavelengths& lambda) const {
    return radiance_at(context, *this, TurnedMap::in_light_space(world_from_light, hit.wi), lambda);
}

std::optional<EmissionSample> SkyLight::sample_le(const LightContext& context, Index, Vec2f u_position,
                                                  Vec2f u_direction, const SampledWavelengths& lambda) const {
    const TurnedMap map = turned_map(context, *this);
    const auto d = map.sample_everywhere(u_direction);
    if (!d) return std::nullopt;
    const SceneDisk disk(context.tables().scene_bounds);
    EmissionSample s;
    s.radiance = radiance_at(context, *this, map.map.grid().direction(d->grid), lambda);
    s.ray = disk.sample(-d->wi, u_position);
    s.pdf_position = disk.pdf();
    s.pdf_direction = d->pdf;
    return s;
}

EmissionPdf SkyLight::pdf_le(const LightContext& context, const LightHit&, Vec3f w) const {
    return {SceneDisk(context.tables().scene_bounds).pdf(), turned_map(context, *this).pdf_everywhere(-w)};
}

void SkyLight::powers(const LightContext& context, std::span<double> parts) const {
    parts[0] = 4 * pi * SceneDisk(context.tables().scene_bounds).area() * double(scale) *
               context.tables().environment(context.light).mean_radiance();
}

std::optional<LightBounds> SkyLight::bounds(const LightContext&, Index) const { return std::nullopt; }

} // namespace montelux
