#include "montelux/scene/light/light_sampling.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace montelux {

namespace {

// f(light); of a light that moves, the still one at the context's time.
template <typename F>
auto visit_light(const LightContext& context, const F& f) {
    return std::visit(
        [&]<typename L>(const L& light) {
            if constexpr (MovableLight<L>)
                if (light.motion != no_index) [[unlikely]]
                    return f(light.moved(context.scene.motions[light.motion].at(context.time)));
            return f(light);
        },
        context.scene.lights[context.light]);
}

} // namespace

std::optional<LightSample> sample_li(const LightContext& context, Index part, const ReferencePoint& from,
                                     Vec2f u, const SampledWavelengths& lambda) {
    // Mostly: a comparison is cheaper than the jump of a visit.
    if (const auto* area = std::get_if<AreaLight>(&context.scene.lights[context.light])) [[likely]]
        return area->sample_li(context, part, from, u, lambda);
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
    std::optional<EmissionSample> sample = visit_light(context, [&](const LightModel auto& light) {
        return light.sample_le(context, part, u_position, u_direction, lambda);
    });
    if (sample) sample->ray.time = context.time;
    return sample;
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
    const auto* area = std::get_if<AreaLight>(&context.scene.lights[context.light]);
    if (area == nullptr || !area->moves(context)) {
        visit_light(context, [&](const LightModel auto& light) { light.powers(context, parts); });
        return;
    }
    // The size of a shape may change. By Simpson's rule: above 0 for a triangle that is flat at one of the times.
    std::vector<double> then(parts.size());
    std::ranges::fill(parts, 0.0);
    for (const auto& [time, weight] : {std::pair{0.0f, 1.0 / 6}, {0.5f, 4.0 / 6}, {1.0f, 1.0 / 6}}) {
        area->powers({context.scene, context.light, time}, then);
        for (std::size_t i = 0; i < parts.size(); ++i) parts[i] += weight * then[i];
    }
}

} // namespace montelux
