// The functions of LightModel for a light of any kind.
#pragma once

#include "montelux/scene/light/light_context.h"

namespace montelux {

// Incident light, for next-event estimation.
std::optional<LightSample> sample_li(const LightContext& context, Index part, const ReferencePoint& from,
                                     Vec2f u, const SampledWavelengths& lambda);
float pdf_li(const LightContext& context, const ReferencePoint& from, const LightHit& hit);
SampledSpectrum incident_radiance(const LightContext& context, const ReferencePoint& from,
                                  const LightHit& hit, const SampledWavelengths& lambda);

// Emission, for methods that trace light from its sources.
std::optional<EmissionSample> sample_le(const LightContext& context, Index part, Vec2f u_position,
                                        Vec2f u_direction, const SampledWavelengths& lambda);
EmissionPdf pdf_le(const LightContext& context, const LightHit& hit, Vec3f w);

// The quantities by which lights are chosen. Bounds are those at the context's time (motion_bounds.h: at any time),
// powers are means over the motion.
std::optional<LightBounds> light_bounds(const LightContext& context, Index part);
Index part_count(const LightContext& context);
void light_powers(const LightContext& context, std::span<double> parts);

} // namespace montelux
