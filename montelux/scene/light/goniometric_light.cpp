#include "montelux/scene/light/goniometric_light.h"

#include "montelux/scene/light/light_context.h"
#include "montelux/scene/light/point_light.h"
#include "montelux/scene/light/turned_map.h"
#include "montelux/scene/light/visible_mean.h"

namespace montelux {

namespace {

TurnedMap turned_map(const LightContext& context, const GoniometricLight& light) {
    return {context.tables().environment(context.light), light.world_from_map};
}

SampledSpectrum intensity(const LightContext& context, const GoniometricLight& light, Vec2f place,
                          const SampledWavelengths& lambda) {
    const LightTablesView& tables = context.tables();
    const float value = tables.map_value(light.environment, tables.environment(context.light).grid(), place);
    return context.scene.sample(light.spectrum, lambda) * (light.scale * value);
}

} // namespace

GoniometricLight GoniometricLight::moved(const Transform& world_from_own) const {
    GoniometricLight light = *this;
    light.world_from_map = world_from_own * world_from_map;
    light.motion = no_index;
    return light;
}

Index GoniometricLight::part_count(const LightContext&) const { return 1; }

std::optional<LightSample> GoniometricLight::sample_li(const LightContext& context, Index,
                                                       const ReferencePoint& from, Vec2f,
                                                       const SampledWavelengths& lambda) const {
    const Vec3f to = from.p - position();
    if (!(length_squared(to) > 0)) return std::nullopt;
    const SampledSpectrum i =
        intensity(context, *this, turned_map(context, *this).place(normalize(to)), lambda);
    if (is_black(i)) return std::nullopt;
    return sample_position(position(), i, from);
}

float GoniometricLight::pdf_li(const LightContext&, const ReferencePoint&, const LightHit&) const {
    return 0;
}

SampledSpectrum GoniometricLight::radiance(const LightContext&, const ReferencePoint&, const LightHit&,
                                           const SampledWavelengths&) const {
    return {};
}

std::optional<EmissionSample> GoniometricLight::sample_le(const LightContext& context, Index, Vec2f, Vec2f u,
                                                          const SampledWavelengths& lambda) const {
    const auto d = turned_map(context, *this).sample_everywhere(u);
    if (!d) return std::nullopt;
    EmissionSample s;
    s.radiance = intensity(context, *this, d->grid, lambda);
    s.ray = {position(), d->wi};
    s.pdf_position = 1;
    s.pdf_direction = d->pdf;
    return s;
}

EmissionPdf GoniometricLight::pdf_le(const LightContext& context, const LightHit&, Vec3f w) const {
    return {0, turned_map(context, *this).pdf_everywhere(w)};
}

// Exact unless the transformation scales unevenly.
void GoniometricLight::powers(const LightContext& context, std::span<double> parts) const {
    parts[0] = 4 * pi * double(scale) * visible_mean(context.scene.spectrum(spectrum)) *
               context.tables().environment(context.light).mean_radiance();
}

std::optional<LightBounds> GoniometricLight::bounds(const LightContext&, Index) const {
    LightBounds b;
    b.box.add(Vec3d(position()));
    return b;
}

} // namespace montelux
