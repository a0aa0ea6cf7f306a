// The frame of a shading normal that a normal map or bumps tilt.
#pragma once

#include <optional>

#include "montelux/scene/material/surface_detail.h"
#include "montelux/scene/shape/surface_point.h"
#include "montelux/scene/view.h"

namespace montelux {

// Bumps are heights above the surface along its shading normal (Blinn 1978, "Simulation of Wrinkled
// Surfaces"); the map is looked up in the frame of the surface with its bumps. `surface` comes with its
// coordinates. Empty where the normal stays as it is, to the last bit.
//
// The normal is on the side of the geometric one, and is turned as little as it takes for the mirror image of
// wo to stay above the surface.
std::optional<Frame> tilted_frame(const SceneView& scene, const SurfaceDetail& detail,
                                  const SurfacePoint& surface, Vec3f wo, const TextureContext& context);

} // namespace montelux
