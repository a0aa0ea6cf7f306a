// Bounds of lights that move: over the whole motion, for light trees, which are built once.
#pragma once

#include "montelux/scene/light/light_context.h"

namespace montelux {

// LightModel::bounds at any time. Exact for motions along chords between keys: positions and normals between two
// keys are convex combinations of those that are bounded. Directions that fill a hemisphere or more count as all.
std::optional<LightBounds> motion_bounds(const LightContext& context, Index part);

// AreaLight::bounds of a shape that moves (AreaLight::moves): those at the context's time.
LightBounds moving_emitter_bounds(const LightContext& context, const AreaLight& light, Index part);

} // namespace montelux
