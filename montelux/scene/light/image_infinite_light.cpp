#include "montelux/scene/light/image_infinite_light.h"

#include <algorithm>

#include "montelux/scene/light/light_context.h"
#include "montelux/scene/light/scene_disk.h"
#include "montelux/scene/light/shadow_ray.h"
#include "montelux/scene/light/turned_map.h"
#include "montelux/scene/light/visible_mean.h"

namespace montelux {

namespace {

TurnedMap turned_map(const LightContext& context, const ImageInfiniteLight& light) {
    return {context.tables().environment(context.light), light.world_from_light};
}

Vec2f place(const EnvironmentGrid& grid, const ImageInfiniteLight& light, Vec3f wi) {
    return grid.locate(TurnedMap::in_light_space(light.world_from_light, wi));
}

SampledSpectrum radiance_at(const LightContext& context, const ImageInfiniteLight& light,
                            const EnvironmentGrid& grid, Vec2f place, const SampledWavelengths& lambda) {
    return context.tables().map_radiance(light, grid, place, lambda) * light.scale;
}

} // namespace

ImageInfiniteLight ImageInfiniteLight::moved(const Transform& world_from_own) const {
    ImageInfiniteLight light = *this;
    light.world_from_light = world_from_own * world_from_light;
    light.motion = no_index;
    return light;
}

Index ImageInfiniteLight::part_count(const LightContext&) const { return 1; }

std::optional<LightSample> ImageInfiniteLight::sample_li(const LightContext& context, Index,
                                                         const ReferencePoint& from, Vec2f u,
                                                         const SampledWavelengths& lambda) const {
    std::optional<LightSample> result;
    const auto add = [&](const EnvironmentGrid& grid, Vec2f at, Vec3f wi, float pdf) {
        LightSample& l = result.emplace();
        l.radiance = radiance_at(context, *this, grid, at, lambda);
        l.wi = wi;
        l.pdf = pdf;
        l.shadow = shadow_ray_to_infinity(from, wi);
    };
    if (portal) {
        const PortalSampler& through = context.tables().portal(context.light);
        if (const auto s = through.sample(from.p, u))
            add(through.grid(), place(through.grid(), *this, s->wi), s->wi, s->pdf);
    } else {
        const TurnedMap map = turned_map(context, *this);
        if (const auto s = map.sample(u)) add(map.map.grid(), s->grid, s->wi, s->pdf);
    }
    return result;
}

float ImageInfiniteLight::pdf_li(const LightContext& context, const ReferencePoint& from,
                                 const LightHit& hit) const {
    if (portal) return context.tables().portal(context.light).pdf(from.p, hit.wi);
    return turned_map(context, *this).pdf(hit.wi);
}

SampledSpectrum ImageInfiniteLight::radiance(const LightContext& context, const ReferencePoint& from,
                                             const LightHit& hit, const SampledWavelengths& lambda) const {
    if (portal && !portal->lets_through(from.p, hit.wi)) return {};
    const LightTablesView& tables = context.tables();
    const EnvironmentGrid& grid =
        portal ? tables.portal(context.light).grid() : tables.environment(context.light).grid();
    return radiance_at(context, *this, grid, place(grid, *this, hit.wi), lambda);
}

std::optional<EmissionSample> ImageInfiniteLight::sample_le(const LightContext& context, Index,
                                                            Vec2f u_position, Vec2f u_direction,
                                                            const SampledWavelengths& lambda) const {
    const SceneDisk disk(context.tables().scene_bounds);
    EmissionSample s;
    if (portal) {
        const PortalSampler& through = context.tables().portal(context.light);
        const auto d = through.sample_direction(u_direction);
        if (!d) return std::nullopt;
        const double cosine = portal->to_local(Vec3d(d->wi)).z;
        if (!(cosine > 0)) return std::nullopt;
        s.radiance = radiance_at(context, *this, through.grid(), place(through.grid(), *this, d->wi), lambda);
        s.ray = disk.through(portal->point(Vec2d(u_position)), -d->wi);
        s.pdf_position = static_cast<float>(1 / (portal->area() * cosine));
        s.pdf_direction = d->pdf;
    } else {
        const TurnedMap map = turned_map(context, *this);
        const auto d = map.sample_everywhere(u_direction);
        if (!d) return std::nullopt;
        s.radiance = radiance_at(context, *this, map.map.grid(), d->grid, lambda);
        s.ray = disk.sample(-d->wi, u_position);
        s.pdf_position = disk.pdf();
        s.pdf_direction = d->pdf;
    }
    return s;
}

EmissionPdf ImageInfiniteLight::pdf_le(const LightContext& context, const LightHit&, Vec3f w) const {
    if (!portal)
        return {SceneDisk(context.tables().scene_bounds).pdf(),
                turned_map(context, *this).pdf_everywhere(-w)};
    const double cosine = portal->to_local(-Vec3d(w)).z;
    if (!(cosine > 0)) return {};
    return {static_cast<float>(1 / (portal->area() * cosine)),
            context.tables().portal(context.light).direction_pdf(-w)};
}

void ImageInfiniteLight::powers(const LightContext& context, std::span<double> parts) const {
    const double cross_section = SceneDisk(context.tables().scene_bounds).area();
    // The photometric normalisation is in `scale`; so is the mean of the white illuminant.
    const Spectrum white(RgbIlluminantSpectrum(LightTablesView::map_color_space(), {1, 1, 1}));
    const double white_scale = double(scale) * visible_mean(white);
    if (portal) {
        const PortalSampler& through = context.tables().portal(context.light);
        parts[0] =
            white_scale * std::min(portal->area() * through.irradiance(), cross_section * through.fluence());
    } else {
        parts[0] = 4 * pi * cross_section * white_scale *
                   context.tables().environment(context.light).mean_radiance();
    }
}

std::optional<LightBounds> ImageInfiniteLight::bounds(const LightContext&, Index) const {
    return std::nullopt;
}

} // namespace montelux
