#include "montelux/scene/light/light_sampling.h"

namespace montelux {

namespace {

template <typename F>
decltype(auto) visit_light(const LightContext& context, const F& f) {
    return std::visit(f, context.scene.lights[context.light]);
}

} // namespace

std::optional<LightSample> sample_li(const LightContext& context, Index part, const ReferencePoint& from,
                                     Vec2f u, const SampledWavelengths& lambda) {
    return visit_light(context, [&](const LightModel auto& light) {
        return light.sample_li(context, part, from, u, lambda);
    });
}

float pdf_li(const LightContext& context, const ReferencePoint& from, const LightHit& hit) {
    return visit_light(context,
                       [&](const LightModel auto& light) { return light.pdf_li(context, from, hit); });
}

SampledSpectrum incident_radiance(const LightContext& context, const ReferencePoint& from,
                                  const LightHit& hit, const SampledWavelengths& lambda) {
    return visit_light(
        context, [&](const LightModel auto& light) { return light.radiance(context, from, hit, lambda); });
}

std::optional<EmissionSample> sample_le(const LightContext& context, Index part, Vec2f u_position,
                                        Vec2f u_direction, const SampledWavelengths& lambda) {
    return visit_light(context, [&](const LightModel auto& light) {
        return light.sample_le(context, part, u_position, u_direction, lambda);
    });
}

EmissionPdf pdf_le(const LightContext& context, const LightHit& hit, Vec3f w) {
    return visit_light(context, [&](const LightModel auto& light) { return light.pdf_le(context, hit, w); });
}

std::optional<LightBounds> light_bounds(const LightContext& context, Index part) {
    return visit_light(context, [&](const LightModel auto& light) { return light.bounds(context, part); });
}

Index part_count(const LightContext& context) {
    return visit_light(context, [&](const LightModel auto& light) { return light.part_count(context); });
}

void light_powers(const LightContext& context, std::span<double> parts) {
    visit_light(context, [&](const LightModel auto& light) { light.powers(context, parts); });
}

} // namespace montelux
